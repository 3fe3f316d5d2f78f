// SPDX-License-Identifier: BSL-1.0
// The samples of a run on their way out: rows of a table, or of the JSON document.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "comparison/json.hpp"
#include "sample_sink.hpp"

namespace nysalt::program {

class samples final : public sample_sink {
 public:
  using sink = std::function<void(std::string_view)>;

  /// Lines of CSV go to `lines`; if it is empty, rows are kept for the document.
  samples(std::vector<std::string> observables, double step, std::int64_t every, sink lines);

  /// Writes the first line, with the names of the columns.
  void begin() override;
  void take(std::int64_t trajectory, const record& segment) override;

  json columns() const;
  const json& rows() const { return rows_; }

 private:
  void hand_on();
  void add(std::int64_t trajectory, std::int64_t n, std::span<const double> values);

  std::vector<std::string> observables_;
  double step_;
  std::int64_t every_;
  sink lines_;
  std::string text_;
  json rows_ = json::array();
};

/// From a table of samples, of every so many of its rows. Throws refusal if the table cannot be read.
first_trajectory read_first_trajectory(const std::string& table, std::int64_t every, std::size_t observables);

}  // namespace nysalt::program
