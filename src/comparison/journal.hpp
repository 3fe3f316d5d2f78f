// SPDX-License-Identifier: BSL-1.0
// Journal of the finished parts of a long computation, from which it is resumed.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "described.hpp"

namespace nysalt::program {

/// Refuses to go on from a file, a journal or a report, that was made for another question; names what
/// differs.
void require_same_question(const json& stored_question, const json& question,
                           const std::filesystem::path& path);

/// In the first line, as `format`.
constexpr const char* format_of_journal = "nysalt journal";

/// A file of one line a finished part, each with a checksum and written as soon as it is there. Numbers in it
/// come back to the bit. A last line that was cut off does not count. Without a file nothing is kept. Rank 0
/// reads and writes the file, and all ranks know what is in it: they make one together, ask for the same
/// parts, and fail alike.
class journal {
 public:
  /// Nowhere.
  journal() = default;
  /// In `file`, of the `question`: parts that were finished for the same question count if `resume`. Throws
  /// refusal if there is a journal and not `resume`, if it is of another question or no journal, if another
  /// process writes it, or if it cannot be written. A file that is no journal is left as it is.
  journal(const std::filesystem::path& file, const json& question, bool resume);

  /// Number of parts at the start.
  std::size_t found() const { return found_.size(); }
  /// What is to be said of these parts: warning_of_origin().
  const std::string& warning() const { return warning_; }
  bool has(const std::string& part) const { return found_.contains(part); }
  /// Nothing was finished, now or before.
  bool is_empty() const { return found_.empty() && !has_written_; }
  /// The result of a part, by the name of the part: read(json) of what was kept, or else that of work(), of
  /// which as_json() is kept. Throws refusal if it cannot be written, and where read() throws: read() must
  /// take nothing of which a later use goes wrong, as another version may have written the file.
  auto once(const std::string& part, const auto& read, const auto& work) {
    if (has(part)) {
      try {
        return read(result_of(part));
      } catch (const std::exception&) {  // of JSON, or that has not what read() needs
        refuse_edited(part);
      }
    }
    auto result = work();
    if (!path_.empty()) keep(part, as_json(result));
    return result;
  }
  /// Takes the file away: all is finished, and written elsewhere. No other rank needs to call it.
  void remove();

 private:
  struct close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  std::string open_file();
  std::size_t read(const std::string& text, const json& question, const std::string& head);
  json result_of(const std::string& part) const;
  [[noreturn]] void refuse_edited(const std::string& part) const;
  void keep(const std::string& part, json result);
  void write(const std::string& text);

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, close> file_;
  std::map<std::string, std::string> found_;  // lines of the file, by their parts
  std::string warning_;
  bool has_written_ = false;
};

}  // namespace nysalt::program
