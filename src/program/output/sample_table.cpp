// SPDX-License-Identifier: BSL-1.0
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <new>
#include <span>
#include <system_error>
#include <utility>

#include "comparison/number.hpp"
#include "comparison/refusal.hpp"
#include "nysalt/atomic_file.hpp"
#include "program/comma_list.hpp"
#include "report/result_file.hpp"
#include "samples.hpp"

namespace nysalt::program {

namespace {

/// Reads what is before the rows of a table: what it says of itself, and the names of its columns.
std::string head_in(std::istream& table) {
  std::string head;
  std::string line;
  do {
    if (!std::getline(table, line)) break;
    head += line + '\n';
  } while (line.starts_with(mark_of_table));
  return head;
}

class sample_table final : public sample_writer {
 public:
  sample_table(sampled_shape shape, json about, std::function<void(std::string_view)> write)
      : sample_writer(std::move(shape)), about_(std::move(about)), write_(std::move(write)) {}

  void begin() override {
    if (write_) write_(head());
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
    head_in(table);
    to.write(head());
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
    head_in(table);
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

  void describe(std::vector<std::string>& columns, json& rows) override {
    columns = {"trajectory", "step", "t"};
    columns.insert(columns.end(), shape_.observables.begin(), shape_.observables.end());
    if (!write_) rows = std::move(rows_);
  }

 private:
  std::string head() const {
    return first_line_of_table(about_) +
           fmt::format("trajectory,step,t,{}\n", fmt::join(shape_.observables, ","));
  }

  void write_gathered() {
    if (!text_.empty()) write_(text_);
    text_.clear();
  }

  json about_;
  std::function<void(std::string_view)> write_;
  std::string text_;
  json rows_ = json::array();
};

/// Calls take(trajectory, at, row) for the rows that begin at bytes first .. end - 1 of a table.
template <class Take>
void each_row(std::ifstream& table, const byte_range& in, const Take& take) {
  table.clear();
  table.seekg(static_cast<std::streamoff>(in.first));
  std::string row;
  for (std::uint64_t at = in.first; at < in.end && std::getline(table, row); at += row.size()) {
    row += '\n';
    std::int64_t trajectory = 0;
    std::from_chars(row.data(), row.data() + row.size(), trajectory);
    take(trajectory, at, row);
  }
}

/// Rows that are gathered, and then put where their trajectories have their places in a file.
class gathered_rows {
 public:
  /// `places`: of the next row of each trajectory; they are put when there are `enough` of `all` bytes.
  gathered_rows(unfinished_file& to, std::vector<std::uint64_t> places, std::size_t enough, std::uint64_t all)
      : to_(to), places_(std::move(places)), enough_(enough) {
    text_.reserve(static_cast<std::size_t>(std::min<std::uint64_t>(enough, all)));
  }

  void take(std::size_t trajectory, std::string_view row) {
    if (text_.size() + row.size() > enough_) put();
    if (pieces_.empty() || pieces_.back().trajectory != trajectory)
      pieces_.push_back({trajectory, text_.size(), text_.size()});
    text_ += row;
    pieces_.back().end = text_.size();
  }

  void put() {
    std::ranges::stable_sort(pieces_, {}, &piece::trajectory);
    std::string together;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const auto& [trajectory, begin, end] = pieces_[i];
      together.append(text_, begin, end - begin);
      if (i + 1 < pieces_.size() && pieces_[i + 1].trajectory == trajectory) continue;
      to_.put(places_[trajectory], std::as_bytes(std::span(together)));
      places_[trajectory] += together.size();
      together.clear();
    }
    text_.clear();
    pieces_.clear();
  }

 private:
  /// Neighbouring rows of one trajectory.
  struct piece {
    std::size_t trajectory;
    std::size_t begin;
    std::size_t end;
  };

  unfinished_file& to_;
  std::vector<std::uint64_t> places_;
  std::size_t enough_;
  std::string text_;
  std::vector<piece> pieces_;
};

/// Puts the rows of trajectories first .. first + count - 1 from some range of a table into a file, from byte
/// `at` on; returns the byte after them.
std::uint64_t put_some(std::ifstream& table, const byte_range& in, std::int64_t first, std::int64_t count,
                       unfinished_file& to, std::uint64_t at, std::size_t enough) {
  const auto each_of_them = [&](const auto& take) {
    each_row(table, in, [&](std::int64_t trajectory, std::uint64_t, std::string_view row) {
      if (trajectory >= first && trajectory - first < count)
        take(static_cast<std::size_t>(trajectory - first), row);
    });
  };
  std::vector<std::uint64_t> places(static_cast<std::size_t>(count));
  each_of_them([&](std::size_t trajectory, std::string_view row) { places[trajectory] += row.size(); });
  const std::uint64_t begin = at;
  for (auto& place : places) at += std::exchange(place, at);
  gathered_rows rows(to, std::move(places), enough, at - begin);
  each_of_them([&](std::size_t trajectory, std::string_view row) { rows.take(trajectory, row); });
  rows.put();
  return at;
}

/// Of each `count` trajectories the range of a table that has all their rows, and perhaps others.
std::vector<byte_range> ranges_of(std::ifstream& table, const byte_range& all, std::int64_t trajectories,
                                  std::int64_t count) {
  if (trajectories <= count) return {all};
  std::vector<byte_range> ranges(static_cast<std::size_t>((trajectories - 1) / count + 1), {all.end, 0});
  each_row(table, all, [&](std::int64_t trajectory, std::uint64_t at, std::string_view) {
    if (trajectory < 0 || trajectory >= trajectories) return;
    byte_range& range = ranges[static_cast<std::size_t>(trajectory / count)];
    range.first = std::min(range.first, at);
    range.end = at + 1;
  });
  return ranges;
}

}  // namespace

std::unique_ptr<sample_writer> table_writer(sampled_shape shape, const json& about,
                                            std::function<void(std::string_view)> write) {
  return std::make_unique<sample_table>(std::move(shape), about, std::move(write));
}

void put_by_trajectory(const std::filesystem::path& from, const std::filesystem::path& to,
                       std::int64_t trajectories, const sorting_room& room) {
  try {
    unfinished_file out(to, unfinished_file::origin::sorted);
    std::ifstream table(from);
    const std::string head = head_in(table);
    out.put(0, std::as_bytes(std::span(head)));
    std::error_code unknown;
    const byte_range rows{head.size(), std::filesystem::file_size(from, unknown)};
    std::uint64_t at = head.size();
    std::int64_t first = 0;
    for (const auto& range : ranges_of(table, rows, trajectories, room.trajectories)) {
      const std::int64_t count = std::min(room.trajectories, trajectories - first);
      at = put_some(table, range, first, count, out, at, room.text);
      first += count;
    }
    if (unknown || at != rows.end) {
      throw nysalt::detail::write_failure(
          message("cannot write {}: {} cannot be read again; go on by --resume where that is mended",
                  to.string(), from.string()));
    }
    out.finish();
  } catch (const std::bad_alloc&) {
    throw nysalt::detail::write_failure(
        message("cannot write {}: no memory is left to sort its rows; make room, and go on by --resume",
                to.string()));
  }
}

}  // namespace nysalt::program
