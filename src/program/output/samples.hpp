// SPDX-License-Identifier: BSL-1.0
// Samples of a run on their way out: as rows of a table or of the JSON document, or as arrays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "comparison/json.hpp"
#include "comparison/sampled_run.hpp"
#include "unfinished_file.hpp"

namespace nysalt::program {

/// Of all trajectories of a run, at steps 0, every, 2 every, ...
struct sampled_shape {
  std::int64_t trajectories;
  std::int64_t samples;  // of each
  std::vector<std::string> observables;
  double step;
  std::int64_t every;
};

/// The observables along trajectory 0, as they are drawn.
struct first_trajectory {
  std::vector<double> t;
  std::vector<std::vector<double>> values;  // of each observable
};

class sample_writer {
 public:
  explicit sample_writer(sampled_shape shape) : shape_(std::move(shape)) {}
  virtual ~sample_writer() = default;

  /// Before the first record of a run that begins.
  virtual void begin() {}
  /// More samples of a trajectory, in the order in which a system hands them over.
  virtual void take(std::int64_t trajectory, const record& segment) = 0;
  /// What was taken is handed on.
  virtual void flush() {}

  /// Writes into a new file all that is known ahead. The writer may refer to it, here and below. Throws
  /// refusal if there is no room for what will come.
  virtual void lay_out(unfinished_file&) {}
  /// Goes on in a file that was left by another run; false if it is not as that one wrote it.
  virtual bool go_on(unfinished_file& file, const file_sum& written) = 0;
  /// Into a file that was laid out, and to which the writer may refer: the samples up to a step of a finished
  /// file of fewer samples, which has that shape and is otherwise alike.
  virtual void copy(const std::filesystem::path& from, unfinished_file& to, const sampled_shape& before,
                    std::int64_t last) = 0;
  /// The record in a saved state of a file of such samples, finished or not; nothing if it is none.
  virtual std::optional<file_sum> sum_in(const std::filesystem::path& file) const = 0;
  /// Of a finished file, of every n-th sample. Throws refusal if it cannot be read.
  virtual first_trajectory read_first(const std::filesystem::path& file, std::int64_t every) const = 0;
  /// The names of the columns of a table, and the rows that were kept for a document.
  virtual void describe(std::vector<std::string>& /*columns*/, json& /*rows*/) {}

 protected:
  sampled_shape shape_;
};

/// Lines of CSV go to `write`, `about` as the first; if it is empty, rows are kept for the document.
std::unique_ptr<sample_writer> table_writer(sampled_shape shape, const json& about,
                                            std::function<void(std::string_view)> write);
/// What put_by_trajectory() holds at a time.
struct sorting_room {
  std::size_t text = std::size_t{1} << 24U;            // bytes of rows
  std::int64_t trajectories = std::int64_t{1} << 20U;  // places of their next rows, 8 bytes each
};
/// Writes the lines of one table of samples into another: its head, and the rows by the trajectory that each
/// begins with; those of one trajectory keep their order. Memory: some 40 MB at most, whatever the length.
/// Throws write_failure if a table cannot be read or written, or memory is short; then an older file is as it
/// was.
void put_by_trajectory(const std::filesystem::path& from, const std::filesystem::path& to,
                       std::int64_t trajectories, const sorting_room& room = {});

/// Every number of a file of arrays has its place from the first moment, where it is put when it is known;
/// what is not taken stays NaN. `about` becomes the attributes of an HDF5 file, and stands as JSON behind the
/// numbers of NumPy's. Throws refusal where there is no HDF5, or such a file would be too large.
std::unique_ptr<sample_writer> array_writer(const std::filesystem::path& file, sampled_shape shape,
                                            const json& about);

}  // namespace nysalt::program
