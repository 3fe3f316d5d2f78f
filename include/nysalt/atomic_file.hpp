// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace nysalt {

/// So that a file which has just got its name keeps it when the power fails; as far as the system can.
void put_folder_on_disk(const std::filesystem::path& file);

/// A file that is there whole or not at all: what is written goes into NAME.WRITER.part, and commit()
/// renames it. Without a commit nothing of it is left, and programs that write the same file at once do not
/// mix, as the writer is the process.
class atomic_file {
 public:
  /// Makes NAME.WRITER.part. Throws std::runtime_error if it cannot be made.
  explicit atomic_file(std::filesystem::path path);
  /// The same under another name of the writer.
  atomic_file(std::filesystem::path path, const std::string& writer);
  ~atomic_file();
  atomic_file(const atomic_file&) = delete;
  atomic_file& operator=(const atomic_file&) = delete;

  /// Appends the text. Throws std::runtime_error if it cannot be written.
  void write(std::string_view text);

  /// Gives the file its name. Throws std::runtime_error if what was written did not arrive; then an older
  /// file is as it was. If it is to be `durable`, it outlasts the machine's power too, which costs some
  /// milliseconds.
  void commit(bool durable = false);

 private:
  void put_on_disk() const;

  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  std::filesystem::path part_;
  std::ofstream stream_;
  bool committed_ = false;
};

}  // namespace nysalt
