// SPDX-License-Identifier: BSL-1.0
#include "sample_arrays.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <span>

#include "comparison/refusal.hpp"

namespace nysalt::program {

sample_arrays::sample_arrays(unfinished_file& file, const array_layout& layout)
    : file_(&file),
      shape_(layout.shape()),
      places_(layout.places_in(file.part())),
      gathered_(places_.values.size()) {}

void sample_arrays::take(std::int64_t trajectory, const record& segment) {
  constexpr std::size_t enough = std::size_t{1} << 20U;  // numbers, in all arrays
  const std::size_t width = shape_.observables.size();
  const std::size_t columns = width / gathered_.size();
  const auto row = static_cast<std::uint64_t>(trajectory * shape_.samples + segment.first / shape_.every);
  for (std::size_t a = 0; a < gathered_.size(); ++a) {
    gathered& numbers = gathered_[a];
    const std::uint64_t at = places_.values[a].first + 8 * row * columns;
    if (numbers.end() != at) {
      hand_on(numbers);
      numbers.at = at;
    }
    for (std::size_t i = a * columns; i < segment.values.size(); i += width) {
      const auto values = std::span(segment.values).subspan(i, columns);
      numbers.numbers.insert(numbers.numbers.end(), values.begin(), values.end());
      if (numbers.numbers.size() >= enough / gathered_.size() + 1) hand_on(numbers);
    }
  }
  if (segment.diverged_at && places_.diverged_at.count > 0) {
    const std::uint64_t at = places_.diverged_at.first + 8 * static_cast<std::uint64_t>(trajectory);
    file_->put(at, std::as_bytes(std::span(&*segment.diverged_at, 1)));
  }
}

void sample_arrays::flush() {
  for (auto& numbers : gathered_) hand_on(numbers);
}

void sample_arrays::hand_on(gathered& numbers) {
  file_->put(numbers.at, std::as_bytes(std::span(numbers.numbers)));
  numbers.at = numbers.end();
  numbers.numbers.clear();
}

first_trajectory read_first_trajectory(const std::filesystem::path& file, const array_layout& layout,
                                       std::int64_t every) {
  const sampled_shape& shape = layout.shape();
  const auto places = layout.places_in(file).values;
  const std::size_t columns = shape.observables.size() / places.size();
  std::ifstream input(file, std::ios::binary);
  first_trajectory result{{}, std::vector<std::vector<double>>(shape.observables.size())};
  for (std::int64_t n = 0; n < shape.samples; n += every) {
    std::vector<double> row(shape.observables.size());
    for (std::size_t a = 0; a < places.size(); ++a) {
      const std::uint64_t at = places[a].first + 8 * columns * static_cast<std::uint64_t>(n);
      input.seekg(static_cast<std::streamoff>(at));
      input.read(reinterpret_cast<char*>(row.data() + a * columns),
                 static_cast<std::streamsize>(8 * columns));
    }
    if (!input) refuse("{} cannot be read again to be drawn", file.string());
    if (std::ranges::all_of(row, [](double x) { return std::isnan(x); })) break;  // the trajectory diverged
    result.t.push_back(static_cast<double>(n * shape.every) * shape.step);
    for (std::size_t k = 0; k < row.size(); ++k) result.values[k].push_back(row[k]);
  }
  return result;
}

}  // namespace nysalt::program
