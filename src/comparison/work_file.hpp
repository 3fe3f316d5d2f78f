// SPDX-License-Identifier: BSL-1.0
// Work under way, in a file beside the output from which it is gone on with.
#pragma once

#include <chrono>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "described.hpp"
#include "nysalt/atomic_file.hpp"

namespace nysalt::program {

/// Refuses to go on from a file, of work or a report, that was made for another question; names what differs.
void require_same_question(const json& stored_question, const json& question,
                           const std::filesystem::path& path);

/// The name of the work file of an output.
inline std::filesystem::path work_of(std::filesystem::path output) { return output += ".work"; }

/// Throws refusal for an output in the place of a work file, which may be needed to go on.
void require_no_work(const std::filesystem::path& output);

/// A question, the finished parts of its answer, and perhaps numbers: lines of JSON, each with a checksum,
/// and then the numbers as they are in memory. Numbers come back to the bit. The file is always whole: it is
/// written anew and takes its name when it is on the disk, at most a twentieth of the time. While it is under
/// way one process holds it. Without a file nothing is kept.
///
/// Rank 0 reads and writes the file, and all ranks know its parts: they make one together, ask for the same
/// parts, and fail alike.
class work_file {
 public:
  /// Nowhere.
  work_file() = default;
  /// In `file`, of the `question`: what was kept for the same question counts if `resume`. Throws refusal if
  /// there are parts and not `resume`, if the file is of another question or no work file, or if another
  /// process writes it, and write_failure if it cannot be written. A file that is no work file is left as it
  /// is.
  work_file(const std::filesystem::path& file, const json& question, bool resume);
  /// What was not written yet is, if it can be; of what has no parts the file goes.
  ~work_file();
  work_file(const work_file&) = delete;
  work_file& operator=(const work_file&) = delete;

  /// Number of parts at the start.
  std::size_t found() const { return found_; }
  /// What is to be said of these parts: warning_of_origin().
  const std::string& warning() const { return warning_; }
  bool has(const std::string& part) const { return lines_.contains(part); }
  /// Nothing was finished, now or before.
  bool is_empty() const { return lines_.empty(); }
  /// The result of a part, by the name of the part: read(json) of what was kept, or else that of work(), of
  /// which as_json() is kept. Throws write_failure if it cannot be written, and refusal where read() throws:
  /// read() must take nothing of which a later use goes wrong, as another version may have written the file.
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

  // Of a state that is replaced as the work goes on; at rank 0.

  /// Whether so much time has gone by that writing the file takes a twentieth of it at most.
  bool is_due() const;
  /// Puts a part and all numbers in the place of older ones, on the disk.
  void replace(const std::string& part, const json& result, std::vector<double> numbers);
  /// Throws refusal for a part that is not there.
  json result_of(const std::string& part) const;
  const std::vector<double>& numbers() const { return numbers_; }

  [[noreturn]] void refuse_edited(const std::string& part) const;
  /// Takes the file away: all is finished, and written elsewhere. No other rank needs to call it.
  void remove();

 private:
  std::string text_of_file();
  json read(std::string_view text);
  void keep(const std::string& part, json result);
  void write(nysalt::atomic_file& next);

  using clock = std::chrono::steady_clock;
  std::filesystem::path path_;
  nysalt::detail::descriptor held_;
  std::string head_;
  std::map<std::string, std::string> lines_;  // by their parts
  std::vector<double> numbers_;
  std::size_t found_ = 0;
  std::string warning_;
  std::optional<nysalt::detail::unfinished_name> name_;  // while there are no parts
  bool is_written_ = true;
  bool has_written_parts_ = false;
  clock::time_point written_at_;
  clock::duration writing_ = {};
};

}  // namespace nysalt::program
