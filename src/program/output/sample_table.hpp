// SPDX-License-Identifier: BSL-1.0
// Samples of a run as rows of a table, or of the JSON document.
#pragma once

#include <functional>
#include <span>
#include <string_view>

#include "sample_writer.hpp"

namespace nysalt::program {

class sample_table final : public sample_writer {
 public:
  /// Lines of CSV go to `write`; if it is empty, rows are kept for the document.
  sample_table(sampled_shape shape, std::function<void(std::string_view)> write);

  /// Writes the first line, with the names of the columns.
  void begin() override;
  void take(std::int64_t trajectory, const record& segment) override;
  bool go_on(unfinished_file& file, const file_sum& written) override { return file.cut_after(written); }
  std::optional<file_sum> sum_in(const std::filesystem::path& file) const override { return sum_of(file); }
  first_trajectory read_first(const std::filesystem::path& file, std::int64_t every) const override;
  void describe(json& document) const override;

 private:
  void hand_on();

  std::function<void(std::string_view)> write_;
  std::string text_;
  json rows_ = json::array();
};

/// Writes the lines of one table of samples into another: its head, and the rows by the trajectory that each
/// begins with; those of one trajectory keep their order. Memory: 24 bytes for each stretch of a trajectory.
/// Throws std::runtime_error if it cannot be read or written; then an older file is as it was.
void put_by_trajectory(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace nysalt::program
