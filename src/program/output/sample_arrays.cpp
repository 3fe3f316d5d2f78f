// SPDX-License-Identifier: BSL-1.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <span>
#include <utility>

#include "comparison/refusal.hpp"
#include "hdf5_layout.hpp"
#include "nysalt/atomic_file.hpp"
#include "samples.hpp"
#include "written_arrays.hpp"

namespace nysalt::program {

namespace {

/// Neighbours in the file are gathered, so that whole trajectories are written some megabytes at a time.
class sample_arrays final : public sample_writer {
 public:
  sample_arrays(const std::filesystem::path& file, sampled_shape shape, json about)
      : sample_writer(std::move(shape)),
        is_npy_(file.extension() == ".npy"),
        about_(std::move(about)),
        gathered_(is_npy_ ? 1 : shape_.observables.size()) {
    if (!is_npy_ && !has_hdf5()) {
      refuse("cannot write {}: this nysalt was built without HDF5; let --output end in .npy or .csv",
             file.string());
    }
    constexpr double most_of_npy = 0x1p31;  // bytes
    constexpr double most_of_all = 0x1p62;
    const double size = 8.0 * static_cast<double>(shape_.trajectories) * static_cast<double>(shape_.samples) *
                        static_cast<double>(shape_.observables.size());
    if (is_npy_ && size > most_of_npy) {
      refuse("{} must have at most two gigabytes as .npy, got {:.3g} bytes; let --output end in .h5",
             file.string(), size);
    }
    if (size > most_of_all)
      refuse("{} must be shorter than 2^62 bytes, got {:.3g}; take a larger --sample-every", file.string(),
             size);
  }

  void take(std::int64_t trajectory, const record& segment) override {
    constexpr std::size_t enough = std::size_t{1} << 20U;  // numbers, in all arrays
    const std::size_t width = shape_.observables.size();
    const std::size_t columns = width / gathered_.size();
    const auto row = static_cast<std::uint64_t>(trajectory * shape_.samples + segment.first / shape_.every);
    for (std::size_t a = 0; a < gathered_.size(); ++a) {
      gathered& numbers = gathered_[a];
      const std::uint64_t at = places_[a].first + 8 * row * columns;
      if (numbers.end() != at) {
        write_gathered(numbers);
        numbers.at = at;
      }
      for (std::size_t i = a * columns; i < segment.values.size(); i += width) {
        const auto values = std::span(segment.values).subspan(i, columns);
        numbers.numbers.insert(numbers.numbers.end(), values.begin(), values.end());
        if (numbers.numbers.size() >= enough / gathered_.size() + 1) write_gathered(numbers);
      }
    }
    if (segment.diverged_at && !is_npy_) {
      const std::uint64_t at = places_.back().first + 8 * static_cast<std::uint64_t>(trajectory);
      file_->put(at, std::as_bytes(std::span(&*segment.diverged_at, 1)));
    }
  }

  void flush() override {
    for (auto& numbers : gathered_) write_gathered(numbers);
  }

  void lay_out(unfinished_file& file) override {
    const auto bytes = 8 * static_cast<std::uint64_t>(shape_.trajectories * shape_.samples) *
                       static_cast<std::uint64_t>(shape_.observables.size());
    std::error_code unknown;
    const auto room = std::filesystem::space(file.part(), unknown);
    if (!unknown && room.available < bytes) {
      refuse("cannot write {}: it takes {} bytes, and its disk has {} left; take a larger --sample-every",
             file.part().string(), bytes, room.available);
    }
    if (is_npy_) {
      const std::string head = npy_head();
      file.put(0, std::as_bytes(std::span(head)));
    } else {
      try {
        json attributes = about_;
        attributes["observables"] = listed(shape_.observables);
        attributes["libraries"]["HDF5"] = hdf5_version();
        make_hdf5(file.part(), datasets(), attributes);
      } catch (const std::runtime_error&) {
        throw nysalt::detail::write_failure(
            message("cannot write {}: the folder is not there, not writable, or full", file.part().string()));
      }
    }
    write_into(file);
    for (std::size_t a = 0; a < gathered_.size(); ++a) {
      fill(places_[a], [](std::int64_t) { return std::numeric_limits<double>::quiet_NaN(); });
    }
    if (is_npy_) {
      const std::string about = about_.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
      return file.put(places_[0].first + 8 * places_[0].count, std::as_bytes(std::span(about)));
    }
    const auto step = [&](std::int64_t n) { return n * shape_.every; };
    const std::size_t others = gathered_.size();
    fill(places_[others], [&](std::int64_t n) { return static_cast<double>(step(n)) * shape_.step; });
    fill(places_[others + 1], step);
    fill(places_[others + 2], [](std::int64_t) { return std::int64_t{-1}; });
  }

  bool go_on(unfinished_file& file, const file_sum& written) override {
    if (sum_in(file.part()) != written) return false;
    write_into(file);
    return true;
  }

  void copy(const std::filesystem::path& from, unfinished_file& to, const sampled_shape& before,
            std::int64_t last) override {
    const std::size_t columns = shape_.observables.size() / gathered_.size();
    const auto places = sample_arrays(from, before, {}).places_in(from);
    std::ifstream input(from, std::ios::binary);
    const auto samples = static_cast<std::uint64_t>(last / shape_.every + 1);
    std::vector<char> bytes;
    const auto copied = [&](std::uint64_t first, std::uint64_t count, std::uint64_t at) {
      constexpr std::uint64_t at_a_time = std::uint64_t{1} << 20U;
      input.seekg(static_cast<std::streamoff>(first));
      for (std::uint64_t done = 0; done < count && input; done += bytes.size()) {
        bytes.resize(std::min(at_a_time, count - done));
        input.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        to.put(at + done, std::as_bytes(std::span(bytes)));
      }
    };
    const auto trajectories = static_cast<std::uint64_t>(shape_.trajectories);
    for (std::size_t a = 0; a < gathered_.size(); ++a) {
      for (std::uint64_t m = 0; m < trajectories; ++m) {
        const auto row = [&](const sampled_shape& of) {
          return 8 * m * static_cast<std::uint64_t>(of.samples) * columns;
        };
        copied(places[a].first + row(before), 8 * samples * columns, places_[a].first + row(shape_));
      }
    }
    for (std::uint64_t m = 0; m < trajectories && !is_npy_ && input; ++m) {
      std::int64_t step = 0;
      input.seekg(static_cast<std::streamoff>(places.back().first + 8 * m));
      input.read(reinterpret_cast<char*>(&step), sizeof step);
      if (step <= last) to.put(places_.back().first + 8 * m, std::as_bytes(std::span(&step, 1)));
    }
    if (!input) refuse("cannot read {}: the file cannot be read again", from.string());
  }

  std::optional<file_sum> sum_in(const std::filesystem::path& file) const override try {
    std::vector<byte_range> left_out;
    for (const auto& one : places_in(file)) left_out.push_back({one.first, one.first + 8 * one.count});
    std::ranges::sort(left_out, {}, &byte_range::first);
    return sum_of(file, left_out);
  } catch (const refusal&) {
    return std::nullopt;
  }

  first_trajectory read_first(const std::filesystem::path& file, std::int64_t every) const override {
    const auto places = places_in(file);
    const std::size_t columns = shape_.observables.size() / gathered_.size();
    std::ifstream input(file, std::ios::binary);
    first_trajectory result{{}, std::vector<std::vector<double>>(shape_.observables.size())};
    for (std::int64_t n = 0; n < shape_.samples; n += every) {
      std::vector<double> row(shape_.observables.size());
      for (std::size_t a = 0; a < gathered_.size(); ++a) {
        const std::uint64_t at = places[a].first + 8 * columns * static_cast<std::uint64_t>(n);
        input.seekg(static_cast<std::streamoff>(at));
        input.read(reinterpret_cast<char*>(row.data() + a * columns),
                   static_cast<std::streamsize>(8 * columns));
      }
      if (!input) refuse("cannot draw {}: the file cannot be read again", file.string());
      if (std::ranges::all_of(row, [](double x) { return std::isnan(x); })) break;  // the trajectory diverged
      result.t.push_back(static_cast<double>(n * shape_.every) * shape_.step);
      for (std::size_t k = 0; k < row.size(); ++k) result.values[k].push_back(row[k]);
    }
    return result;
  }

 private:
  /// Numbers of eight bytes, one after the other in a file.
  struct array_place {
    std::uint64_t first;  // byte
    std::uint64_t count;
  };
  struct gathered {
    std::uint64_t at = 0;  // byte in the file
    std::vector<double> numbers = {};
    std::uint64_t end() const { return at + 8 * numbers.size(); }
  };

  /// There is one array of trajectories x samples for each observable, and t, step and diverged_at (HDF5), or
  /// one of trajectories x samples x observables (NumPy).
  std::vector<dataset> datasets() const {
    const auto trajectories = static_cast<std::uint64_t>(shape_.trajectories);
    const auto samples = static_cast<std::uint64_t>(shape_.samples);
    if (is_npy_) return {{"", {trajectories, samples, shape_.observables.size()}}};
    std::vector<dataset> all;
    for (const auto& name : shape_.observables) all.push_back({name, {trajectories, samples}});
    all.push_back({"t", {samples}});
    all.push_back({"step", {samples}, true});
    all.push_back({"diverged_at", {trajectories}, true});
    return all;
  }

  std::string npy_head() const {
    return program::npy_head({shape_.trajectories, shape_.samples, std::ssize(shape_.observables)});
  }

  std::vector<array_place> places_in(const std::filesystem::path& file) const {
    const auto all = datasets();
    std::vector<array_place> places;
    try {
      const auto first = is_npy_ ? std::vector<std::uint64_t>{npy_head().size()} : places_in_hdf5(file, all);
      for (std::size_t k = 0; k < all.size(); ++k) places.push_back({first[k], all[k].count()});
    } catch (const std::runtime_error&) {
      refuse("cannot read {}: the file is not that of the arrays of the run", file.string());
    }
    return places;
  }

  /// Puts number(0), number(1), ... there, some megabytes at a time.
  template <class Number>
  void fill(const array_place& place, const Number& number) {
    constexpr std::uint64_t at_a_time = std::uint64_t{1} << 20U;
    std::vector<decltype(number(std::int64_t{}))> some;
    for (std::uint64_t done = 0; done < place.count; done += some.size()) {
      some.resize(std::min(at_a_time, place.count - done));
      for (std::uint64_t i = 0; i < some.size(); ++i) some[i] = number(static_cast<std::int64_t>(done + i));
      file_->put(place.first + 8 * done, std::as_bytes(std::span(some)));
    }
  }

  void write_into(unfinished_file& file) {
    file_ = &file;
    try {
      places_ = places_in(file.part());
    } catch (const refusal&) {
      file.require_own();  // or another file took the place of the part
      throw;
    }
  }

  void write_gathered(gathered& numbers) {
    file_->put(numbers.at, std::as_bytes(std::span(numbers.numbers)));
    numbers.at = numbers.end();
    numbers.numbers.clear();
  }

  bool is_npy_;
  json about_;
  unfinished_file* file_ = nullptr;
  std::vector<array_place> places_;  // of the datasets
  std::vector<gathered> gathered_;   // of each array of values
};

}  // namespace

std::unique_ptr<sample_writer> array_writer(const std::filesystem::path& file, sampled_shape shape,
                                            const json& about) {
  return std::make_unique<sample_arrays>(file, std::move(shape), about);
}

}  // namespace nysalt::program
