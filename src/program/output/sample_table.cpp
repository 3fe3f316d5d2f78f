// SPDX-License-Identifier: BSL-1.0
#include <fmt/format.h>

#include <algorithm>
#include <boost/interprocess/file_mapping.hpp>
#include <boost/interprocess/mapped_region.hpp>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <span>
#include <stdexcept>
#include <utility>

#include "comparison/number.hpp"
#include "comparison/refusal.hpp"
#include "nysalt/atomic_file.hpp"
#include "program/comma_list.hpp"
#include "samples.hpp"

namespace nysalt::program {

namespace {

class sample_table final : public sample_writer {
 public:
  sample_table(sampled_shape shape, std::function<void(std::string_view)> write)
      : sample_writer(std::move(shape)), write_(std::move(write)) {}

  void begin() override {
    if (write_) write_(fmt::format("trajectory,step,t,{}\n", fmt::join(shape_.observables, ",")));
  }

  void take(std::int64_t trajectory, const record& segment) override {
    constexpr std::size_t enough = std::size_t{1} << 20U;
    const std::size_t width = shape_.observables.size();
    for (std::size_t i = 0; i < segment.values.size(); i += width) {
      const std::int64_t n = segment.first + static_cast<std::int64_t>(i / width) * shape_.every;
      const double t = static_cast<double>(n) * shape_.step;
      const auto values = std::span(segment.values).subspan(i, width);
      if (write_) {
        text_ += fmt::format("{},{},{}", trajectory, n, t);
        for (const double x : values) text_ += std::isfinite(x) ? fmt::format(",{}", x) : std::string(",");
        text_ += '\n';
        if (text_.size() > enough) write_gathered();
      } else {
        json& row = rows_.emplace_back(json{trajectory, n, t});
        for (const double x : values) row.push_back(x);
      }
    }
    write_gathered();
  }

  bool go_on(unfinished_file& file, const file_sum& written) override { return file.cut_after(written); }
  void copy(const std::filesystem::path& from, unfinished_file& to, const sampled_shape&,
            std::int64_t last) override {
    std::ifstream table(from);
    std::string row;
    std::getline(table, row);
    to.write(row + '\n');
    while (std::getline(table, row)) {
      std::int64_t step = 0;
      std::from_chars(row.data() + row.find(',') + 1, row.data() + row.size(), step);
      if (step <= last) to.write(row + '\n');
    }
    if (!table.eof()) refuse("cannot read {}: the file cannot be read again", from.string());
  }

  std::optional<file_sum> sum_in(const std::filesystem::path& file) const override { return sum_of(file); }

  first_trajectory read_first(const std::filesystem::path& file, std::int64_t every) const override {
    std::ifstream table(file);
    std::string row;
    std::getline(table, row);
    first_trajectory result{{}, std::vector<std::vector<double>>(shape_.observables.size())};
    for (std::int64_t n = 0; std::getline(table, row) && row.starts_with("0,"); ++n) {
      if (n % every != 0) continue;
      const auto fields = split_at_commas(row);
      const auto number = [&](std::size_t k) {
        const auto value = k < fields.size() ? number_from(fields[k]) : std::nullopt;
        return value.value_or(std::numeric_limits<double>::quiet_NaN());
      };
      result.t.push_back(number(2));
      for (std::size_t k = 0; k < result.values.size(); ++k) result.values[k].push_back(number(3 + k));
    }
    if (result.t.empty()) refuse("cannot draw {}: the file cannot be read again", file.string());
    return result;
  }

  void describe(json& document) const override {
    document["columns"] = {"trajectory", "step", "t"};
    for (const auto& name : shape_.observables) document["columns"].push_back(name);
    if (!write_) document["rows"] = rows_;
  }

 private:
  void write_gathered() {
    if (!text_.empty()) write_(text_);
    text_.clear();
  }

  std::function<void(std::string_view)> write_;
  std::string text_;
  json rows_ = json::array();
};

/// Neighbouring rows of one trajectory.
struct piece {
  std::int64_t trajectory;
  std::size_t begin;
  std::size_t end;
};

}  // namespace

std::unique_ptr<sample_writer> table_writer(sampled_shape shape,
                                            std::function<void(std::string_view)> write) {
  return std::make_unique<sample_table>(std::move(shape), std::move(write));
}

void put_by_trajectory(const std::filesystem::path& from, const std::filesystem::path& to) {
  namespace ipc = boost::interprocess;
  try {
    const ipc::file_mapping file(from.c_str(), ipc::read_only);
    const ipc::mapped_region region(file, ipc::read_only);
    const std::string_view text(static_cast<const char*>(region.get_address()), region.get_size());
    const std::size_t head = std::min(text.find('\n'), text.size() - 1) + 1;
    std::vector<piece> pieces;
    for (std::size_t begin = head; begin < text.size();) {
      std::int64_t trajectory = 0;
      std::from_chars(text.data() + begin, text.data() + text.size(), trajectory);
      const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
      if (pieces.empty() || pieces.back().trajectory != trajectory)
        pieces.push_back({trajectory, begin, end});
      pieces.back().end = end;
      begin = end;
    }
    std::ranges::stable_sort(pieces, {}, &piece::trajectory);
    atomic_file out(to, "sorted");  // a kill leaves one such file at most, which the next run writes again
    out.write(text.substr(0, head));
    for (const auto& one : pieces) out.write(text.substr(one.begin, one.end - one.begin));
    out.commit(true);
  } catch (const ipc::interprocess_exception& problem) {
    throw std::runtime_error(fmt::format("cannot read {}: {}", from.string(), problem.what()));
  }
}

}  // namespace nysalt::program
