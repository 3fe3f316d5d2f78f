// SPDX-License-Identifier: BSL-1.0
// Programs that are started without a shell: the compiler of plug-ins, and gnuplot.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace nysalt::program {

/// What a child process left.
struct child_result {
  std::optional<int>
      code;            ///< exit code, or 128 and the number of a signal; none if the program did not start
  std::string output;  ///< what the program wrote

  bool succeeded() const { return code == 0; }
};

enum class error_output { kept, dropped };

/// Runs a program, found on the PATH from the folder of this process, in a folder, and waits for the end. Its
/// messages are in English. The output is collected, with the standard error or without; the input is empty.
/// A signal that ends this process ends the child first.
child_result run_child(const std::vector<std::string>& command, const std::filesystem::path& folder,
                       error_output errors);

/// Ends the child that runs, if one does, and waits for at most a second. Async-signal-safe.
void end_child() noexcept;

}  // namespace nysalt::program
