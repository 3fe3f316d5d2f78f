// SPDX-License-Identifier: BSL-1.0
#include "written_arrays.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "comparison/inputs.hpp"
#include "comparison/refusal.hpp"
#include "hdf5_layout.hpp"

namespace nysalt::program {

bool is_of_arrays(const std::filesystem::path& file) {
  const std::string ending = file.extension();
  return ending == ".h5" || ending == ".hdf5" || ending == ".npy";
}

std::string npy_head(const std::array<std::int64_t, 3>& shape) {
  std::string text = fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, {}, {}), }}",
                                 shape[0], shape[1], shape[2]);
  constexpr std::size_t before = 10;
  text.append(63 - (before + text.size()) % 64, ' ');
  text += '\n';
  std::string head("\x93NUMPY\x01\x00", 8);
  head += static_cast<char>(text.size() % 256);
  head += static_cast<char>(text.size() / 256);
  return head + text;
}

namespace {

constexpr std::int64_t most_numbers = std::int64_t{1} << 59U;  // of a file shorter than 2^62 bytes

/// Whether arrays of that shape are not empty, and fit into a file.
bool is_sound(const std::array<std::int64_t, 3>& shape) {
  std::int64_t left = most_numbers;
  for (const std::int64_t length : shape) {
    if (length < 1 || length > left) return false;
    left /= length;
  }
  return true;
}

}  // namespace

written_arrays::written_arrays(const std::string& option, const std::string& file)
    : where_(option.empty() ? file : option + " " + file), file_(file) {
  note_input(file_);
  std::error_code ignored;
  input_.open(file_, std::ios::binary);
  if (!std::filesystem::is_regular_file(file_, ignored) || !input_) {
    refuse("cannot read {}: the file is missing or not readable; name an output of run", where_);
  }
  if (file_.extension() == ".npy") {
    find_in_npy();
  } else {
    find_in_hdf5();
  }
}

double written_arrays::number(std::int64_t trajectory, std::int64_t sample, std::size_t observable) {
  const auto at = static_cast<std::uint64_t>((trajectory * samples_ + sample) * apart_);
  double value = 0.0;
  input_.seekg(static_cast<std::streamoff>(first_[observable] + 8 * at));
  input_.read(reinterpret_cast<char*>(&value), sizeof value);
  if (!input_) refuse("cannot read {}: the file was cut off; name a whole one", where_);
  return value;
}

void written_arrays::find_in_npy() {
  constexpr std::string_view before_shape = "'shape': (";
  std::string head(256, '\0');
  input_.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(input_.gcount()));
  input_.clear();
  std::array<std::int64_t, 3> shape{};
  const auto at = head.find(before_shape);
  if (at == std::string::npos) refuse_foreign();
  const char* next = head.data() + at + before_shape.size();
  for (auto& length : shape) {
    next = std::from_chars(next, head.data() + head.size(), length).ptr;
    next += std::min<std::ptrdiff_t>(2, head.data() + head.size() - next);  // ", "
  }
  if (!is_sound(shape) || !head.starts_with(npy_head(shape))) refuse_foreign();
  const auto end = npy_head(shape).size() + 8 * static_cast<std::uint64_t>(shape[0] * shape[1] * shape[2]);
  std::error_code ignored;
  const std::uint64_t size = std::filesystem::file_size(file_, ignored);
  if (size <= end) refuse_foreign();
  std::string behind(std::min<std::uint64_t>(size - end, longest_document), '\0');
  input_.seekg(static_cast<std::streamoff>(end));
  input_.read(behind.data(), static_cast<std::streamsize>(behind.size()));
  about_ = parsed(behind);
  try {
    observables_ = about_.at("observables").get<std::vector<std::string>>();
    every_ = about_.at("sample_every").get<std::int64_t>();
  } catch (const json::exception&) {
    refuse_foreign();
  }
  if (std::ssize(observables_) != shape[2] || every_ < 1) refuse_foreign();
  trajectories_ = shape[0];
  samples_ = shape[1];
  apart_ = shape[2];
  for (std::size_t k = 0; k < observables_.size(); ++k) first_.push_back(npy_head(shape).size() + 8 * k);
}

void written_arrays::find_in_hdf5() {
  if (!has_hdf5()) refuse("cannot read {}: this nysalt was built without HDF5; take .npy or .csv", where_);
  std::vector<std::pair<dataset, std::uint64_t>> all;
  try {
    all = datasets_in_hdf5(file_);
    for (const char* name : {"method", "description"}) about_[name] = text_in_hdf5(file_, name);
  } catch (const std::runtime_error&) {
    refuse_foreign();
  }
  std::vector<std::uint64_t> shape;
  for (const auto& [one, first] : all) {
    if (one.is_of_integers || one.shape.size() != 2) continue;
    if (!shape.empty() && one.shape != shape) refuse_foreign();
    shape = one.shape;
    observables_.push_back(one.name);
    first_.push_back(first);
  }
  const auto steps = std::ranges::find_if(
      all, [](const auto& one) { return one.first.name == "step" && one.first.is_of_integers; });
  if (shape.empty() || steps == all.end() || steps->first.count() != shape[1]) refuse_foreign();
  trajectories_ = static_cast<std::int64_t>(shape[0]);
  samples_ = static_cast<std::int64_t>(shape[1]);
  if (!is_sound({trajectories_, samples_, 1})) refuse_foreign();
  if (samples_ == 1) return;
  input_.seekg(static_cast<std::streamoff>(steps->second + sizeof every_));
  input_.read(reinterpret_cast<char*>(&every_), sizeof every_);
  if (!input_ || every_ < 1) refuse_foreign();
}

void written_arrays::refuse_foreign() const {
  refuse("cannot read {}: the file must be a whole output of nysalt run; name another file", where_);
}

}  // namespace nysalt::program
