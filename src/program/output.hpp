// SPDX-License-Identifier: BSL-1.0
// Results on their way out: standard output and files.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "comparison/prepared_problem.hpp"
#include "comparison/work_file.hpp"
#include "report/result_file.hpp"
#include "report/terminal.hpp"

namespace nysalt::program {

/// Prints to standard output. Throws refusal if it cannot be written; a reader who went away is no error.
void print(std::string_view text);

/// How results are printed: in 110 columns, or those of the terminal where it has fewer.
text_form form_of(const common_settings& common);

/// The line that says that a file was written; of the name what terminals take for commands is replaced.
std::string line_of_written(std::string_view file);

/// Writes results to files, and prints them, be they written or not: work is not lost with a disk that is
/// full. What the writing throws is thrown after that. The printing gets whether all was written.
void write_and_print(const std::function<void()>& write, const std::function<void(bool written)>& print_all);

/// Throws refusal now if a file could not be written there later.
void require_writable(const std::filesystem::path& file);

/// The same of a result, which takes no place of a file from which something can be gone on with.
void require_result(const std::filesystem::path& file);

/// The work file of an output, from which --resume goes on; none without an output, where --resume is
/// refused, as where there is nothing but a finished output.
std::unique_ptr<work_file> begin_work(const std::string& output, const json& question, bool resume);

/// Warns of what was taken from a work file, if there is one: of its parts, and of another origin alone.
void tell_of_parts(const work_file* work);
void tell_of_origin(const work_file* work);

/// All that decides the result of a command, by the options that were given.
json question_of(const prepared_problem& system, const common_settings& common);

/// Whether two paths lead to one file, be it there or not.
bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// Throws refusal now if a table could not be written there later, or its picture not beside it: after the
/// inputs were read. Nothing is asked of an output that is empty, but that there is no picture.
/// An ending other than .csv and .txt, and those of arrays if it may be one, is refused.
void require_table(const std::string& output, bool plot, bool may_be_array);
/// Of a picture beside a table: that of the table, in letters that gnuplot takes, and of no other table in
/// the folder: with a fingerprint of the whole name unless the table is that name and .csv.
std::string picture_name(const std::filesystem::path& table);

/// Throws refusal now if a folder could not be made there later, or not be written into.
void require_folder(const std::filesystem::path& folder);

/// The same of files in a folder.
void require_files_in(const std::filesystem::path& folder, const std::vector<std::string>& files);

/// Makes a folder, and those it lies in, where there is none; which were made, the outermost first.
std::vector<std::filesystem::path> make_folder(const std::filesystem::path& folder);

/// The folder that a file is in.
std::filesystem::path folder_of(const std::filesystem::path& file);

/// One line of plain characters on standard error, for any text that was typed or read from a file.
void complain(std::string text);

/// The same, of what is no error.
void warn(std::string_view text);

/// Where a rank has more threads than cores.
void warn_of_threads(const common_settings& common);

}  // namespace nysalt::program
