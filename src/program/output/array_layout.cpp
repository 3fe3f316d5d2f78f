// SPDX-License-Identifier: BSL-1.0
#include "array_layout.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

#include "comparison/refusal.hpp"

namespace nysalt::program {

namespace {

/// Puts number(0), number(1), ... there, some megabytes at a time.
template <class Number>
void fill(unfinished_file& file, const array_place& place, const Number& number) {
  constexpr std::uint64_t at_a_time = std::uint64_t{1} << 20U;
  std::vector<decltype(number(std::uint64_t{}))> some;
  for (std::uint64_t done = 0; done < place.count; done += some.size()) {
    some.resize(std::min(at_a_time, place.count - done));
    for (std::uint64_t i = 0; i < some.size(); ++i) some[i] = number(done + i);
    file.put(place.first + 8 * done, std::as_bytes(std::span(some)));
  }
}

std::vector<array_place> all_of(const array_places& places) {
  std::vector<array_place> all = places.values;
  for (const auto& one : {places.t, places.step, places.diverged_at}) {
    if (one.count > 0) all.push_back(one);
  }
  std::ranges::sort(all, {}, &array_place::first);
  return all;
}

}  // namespace

bool array_layout::is_of(const std::filesystem::path& file) {
  const std::string ending = file.extension();
  return ending == ".h5" || ending == ".hdf5" || ending == ".npy";
}

array_layout::array_layout(const std::filesystem::path& file, sampled_shape shape, json about)
    : is_npy_(file.extension() == ".npy"), shape_(std::move(shape)), about_(std::move(about)) {
  if (!is_npy_ && !has_hdf5()) {
    refuse("cannot write {}: this nysalt was built without HDF5; let --output end in .npy or .csv",
           file.string());
  }
  constexpr double most_of_npy = 0x1p31;  // bytes
  constexpr double most_of_all = 0x1p62;
  const double size = 8.0 * static_cast<double>(shape_.trajectories) * static_cast<double>(shape_.samples) *
                      static_cast<double>(shape_.observables.size());
  if (is_npy_ && size > most_of_npy) {
    refuse("{} would have {:.3g} bytes, and .npy is for two gigabytes at most: let --output end in .h5",
           file.string(), size);
  }
  if (size > most_of_all)
    refuse("{} would have {:.3g} bytes: take a larger --sample-every", file.string(), size);
}

void array_layout::lay_out(unfinished_file& file) const {
  std::error_code unknown;
  const auto room = std::filesystem::space(file.part(), unknown);
  if (!unknown && room.available < bytes()) {
    refuse("cannot write {}: it takes {} bytes, and its disk has {} left; take a larger --sample-every",
           file.part().string(), bytes(), room.available);
  }
  if (is_npy_) {
    const std::string head = npy_head();
    file.put(0, std::as_bytes(std::span(head)));
  } else {
    try {
      make_hdf5(file.part(), datasets(), about_);
    } catch (const std::runtime_error&) {
      refuse("cannot write {}: is the folder writable, and its disk not full?", file.part().string());
    }
  }
  const array_places places = places_in(file.part());
  const auto step = [&](std::uint64_t n) { return static_cast<std::int64_t>(n) * shape_.every; };
  fill(file, places.step, step);
  fill(file, places.t, [&](std::uint64_t n) { return static_cast<double>(step(n)) * shape_.step; });
  fill(file, places.diverged_at, [](std::uint64_t) { return std::int64_t{-1}; });
  for (const auto& one : places.values) {
    fill(file, one, [](std::uint64_t) { return std::numeric_limits<double>::quiet_NaN(); });
  }
}

array_places array_layout::places_in(const std::filesystem::path& file) const {
  array_places result;
  if (is_npy_) {
    result.values.push_back({npy_head().size(), shape_.numbers() * shape_.observables.size()});
    return result;
  }
  try {
    const auto places = places_in_hdf5(file, datasets());
    for (std::size_t k = 0; k < shape_.observables.size(); ++k) {
      result.values.push_back({places[k], shape_.numbers()});
    }
    const auto samples = static_cast<std::uint64_t>(shape_.samples);
    result.t = {places[places.size() - 3], samples};
    result.step = {places[places.size() - 2], samples};
    result.diverged_at = {places[places.size() - 1], static_cast<std::uint64_t>(shape_.trajectories)};
    return result;
  } catch (const std::runtime_error&) {
    refuse("{} is not the file of arrays that the run left there", file.string());
  }
}

std::optional<file_sum> array_layout::sum_of_head(const std::filesystem::path& file) const {
  try {
    std::vector<byte_range> left_out;
    for (const auto& one : all_of(places_in(file))) left_out.push_back({one.first, one.end()});
    return sum_of(file, left_out);
  } catch (const refusal&) {
    return std::nullopt;
  }
}

std::vector<hdf5_dataset> array_layout::datasets() const {
  const auto trajectories = static_cast<std::uint64_t>(shape_.trajectories);
  const auto samples = static_cast<std::uint64_t>(shape_.samples);
  std::vector<hdf5_dataset> all;
  for (const auto& name : shape_.observables) all.push_back({name, {trajectories, samples}});
  all.push_back({"t", {samples}});
  all.push_back({"step", {samples}, true});
  all.push_back({"diverged_at", {trajectories}, true});
  return all;
}

/// Of version 1.0: six bytes of magic, two of the version, two of the length of what follows, a literal of
/// Python, and blanks up to a multiple of 64 bytes in all.
std::string array_layout::npy_head() const {
  std::string text = fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, {}, {}), }}",
                                 shape_.trajectories, shape_.samples, shape_.observables.size());
  constexpr std::size_t before = 10;
  text.append(63 - (before + text.size()) % 64, ' ');
  text += '\n';
  std::string head("\x93NUMPY\x01\x00", 8);
  head += static_cast<char>(text.size() % 256);
  head += static_cast<char>(text.size() / 256);
  return head + text;
}

std::uint64_t array_layout::bytes() const {
  return 8 * shape_.numbers() * static_cast<std::uint64_t>(shape_.observables.size());
}

}  // namespace nysalt::program
