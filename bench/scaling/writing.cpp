// SPDX-License-Identifier: BSL-1.0
// What rank 0 does alone: rows of a number, a time and two observables, as text and as bytes.
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "measure.hpp"
#include "sizes.hpp"

namespace nysalt::bench {

namespace {

constexpr std::int64_t rows = 200'000;

double observed(std::int64_t m, double phase) { return std::sin(static_cast<double>(m) + phase); }

std::int64_t write_text(const std::filesystem::path& path) {
  std::string text;
  for (std::int64_t m = 0; m < rows; ++m) {
    fmt::format_to(std::back_inserter(text), "{},{},{},{}\n", m, 0.5, observed(m, 0.0), observed(m, 1.0));
  }
  std::ofstream(path, std::ios::binary) << text;
  return static_cast<std::int64_t>(text.size());
}

std::int64_t write_bytes(const std::filesystem::path& path) {
  std::vector<double> numbers;
  for (std::int64_t m = 0; m < rows; ++m) {
    for (const double x : {static_cast<double>(m), 0.5, observed(m, 0.0), observed(m, 1.0)}) {
      numbers.push_back(x);
    }
  }
  const auto size = static_cast<std::int64_t>(numbers.size() * sizeof(double));
  std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(numbers.data()), size);
  return size;
}

}  // namespace

void measure_writing(const std::filesystem::path& folder) {
  for (int round = 0; round < 5; ++round) {
    for (const bool is_text : {true, false}) {
      wait_for_all();
      if (rank_of_job() != 0) continue;
      using clock = std::chrono::steady_clock;
      const auto path = folder / "rows.tmp";
      const auto began = clock::now();
      const std::int64_t size = is_text ? write_text(path) : write_bytes(path);
      const double seconds = std::chrono::duration<double>(clock::now() - began).count();
      std::filesystem::remove(path);
      print_row({{"what", is_text ? "row of text" : "row of bytes"},
                 {"bytes", static_cast<double>(size) / rows},
                 {"seconds", seconds / rows}});
    }
  }
}

}  // namespace nysalt::bench
