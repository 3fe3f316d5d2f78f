// SPDX-License-Identifier: BSL-1.0
#include "checkpoint.hpp"

#include <algorithm>
#include <bit>
#include <boost/crc.hpp>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "build_info.hpp"
#include "comparison/refusal.hpp"
#include "nysalt/atomic_file.hpp"
#include "program/output.hpp"
#include "report/manifest.hpp"

namespace nysalt::program {

namespace {

constexpr const char* format = "nysalt checkpoint";
constexpr int format_version = 1;

static_assert(std::endian::native == std::endian::little, "checkpoints hold doubles as this machine does");

std::string last_line(std::string_view before) {
  boost::crc_32_type sum;
  sum.process_bytes(before.data(), before.size());
  return fmt::format("\ncrc32 {:08x}\n", sum.checksum());
}

[[noreturn]] void refuse_broken(const std::filesystem::path& file) {
  refuse("{} is not whole, or was edited: take an older copy, or remove it and begin anew", file.string());
}

/// The line that a checkpoint begins with; discarded if it is none.
json head_of(std::string_view text) {
  const json head = json::parse(text.substr(0, text.find('\n')), nullptr, false);
  if (!head.is_object() || head.value("format", json()) != format) return json(json::value_t::discarded);
  return head;
}

/// Of json's own conversions, that of a large double is undefined.
std::int64_t whole(const json& value) {
  if (!value.is_number_integer()) throw std::invalid_argument("not a whole number");
  return value.get<std::int64_t>();
}

std::int64_t count_in(const json& head, const char* name, std::int64_t most) {
  const std::int64_t value = whole(head.at(name));
  if (value < 0 || value > most) throw std::out_of_range(name);
  return value;
}

checkpoint from(const json& head, std::string_view bytes) {
  constexpr std::int64_t most = std::int64_t{1} << 53U;
  checkpoint state;
  state.question = head.at("question");
  state.at.first = count_in(head, "first", most);
  state.at.wave.step = count_in(head, "step", most);
  for (const auto& step : head.at("wave")) {
    std::optional<std::int64_t> lost;
    if (!step.is_null()) lost = whole(step);
    state.at.wave.diverged_at.push_back(lost);
  }
  for (const auto& one : head.at("diverged")) {
    state.lost.push_back({count_in(one, "trajectory", most), count_in(one, "step", most)});
  }
  const std::int64_t trajectories = whole(state.question.at("trajectories"));
  const std::int64_t steps = whole(state.question.at("steps"));
  const std::int64_t step = state.at.wave.step;
  const auto is_of_it = [&](const diverged_trajectory& one) {
    return one.trajectory < trajectories && one.step <= steps;
  };
  if (state.at.first + std::ssize(state.at.wave.diverged_at) > trajectories || step > steps ||
      (step % steps_between_checks != 0 && step != steps) || !std::ranges::all_of(state.lost, is_of_it)) {
    throw std::out_of_range("first");
  }
  state.output = head.value("output", std::string());
  state.written.length = static_cast<std::uint64_t>(count_in(head, "length", std::int64_t{1} << 62U));
  state.written.crc = static_cast<std::uint32_t>(count_in(head, "sum", 0xffffffff));
  state.in_order = head.at("in_order").get<bool>();
  state.finished = head.at("finished").get<bool>();
  state.version = head.at("nysalt").get<std::string>();
  auto& numbers = state.at.wave.numbers;
  numbers.resize(bytes.size() / sizeof(double));
  const std::size_t wave = std::max<std::size_t>(state.at.wave.diverged_at.size(), 1);
  if (numbers.size() * sizeof(double) != bytes.size() || numbers.size() % wave != 0) {
    throw std::out_of_range("numbers");
  }
  if (!bytes.empty()) std::memcpy(numbers.data(), bytes.data(), bytes.size());  // of none there is no address
  return state;
}

}  // namespace

void write_checkpoint(const std::filesystem::path& file, const checkpoint& state) {
  json wave = json::array();
  for (const auto& step : state.at.wave.diverged_at) wave.push_back(step ? json(*step) : json(nullptr));
  json diverged = json::array();
  for (const auto& one : state.lost) diverged.push_back({{"trajectory", one.trajectory}, {"step", one.step}});
  const json head{{"format", format},
                  {"version", format_version},
                  {"nysalt", version},
                  {"question", state.question},
                  {"first", state.at.first},
                  {"step", state.at.wave.step},
                  {"wave", wave},
                  {"diverged", diverged},
                  {"output", state.output},
                  {"length", state.written.length},
                  {"sum", state.written.crc},
                  {"in_order", state.in_order},
                  {"finished", state.finished}};
  const auto& numbers = state.at.wave.numbers;
  std::string text = head.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
  const std::size_t at = text.size();
  text.resize(at + numbers.size() * sizeof(double));
  if (!numbers.empty()) std::memcpy(text.data() + at, numbers.data(), numbers.size() * sizeof(double));
  text += last_line(text);
  atomic_file out(file, "next");  // one process writes checkpoints: a kill leaves one such file at most
  out.write(text);
  out.commit(true);
}

checkpoint read_checkpoint(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    refuse("there is no checkpoint {}: leave --resume away to begin", file.string());
  }
  std::ifstream input(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(input), {}};
  const json head = head_of(text);
  if (head.is_discarded()) {
    refuse("{} is no checkpoint of nysalt, or was cut off: name another file", file.string());
  }
  const json file_version = head.value("version", json());
  if (file_version.is_number_integer() && file_version > format_version) {
    refuse("{} was written by a newer nysalt (format {}, this one reads {}): go on with that one",
           file.string(), file_version.dump(), format_version);
  }
  const std::size_t last_length = last_line("").size();
  if (text.size() < last_length) refuse_broken(file);
  const auto before = std::string_view(text).substr(0, text.size() - last_length);
  if (!text.ends_with(last_line(before))) refuse_broken(file);
  try {
    const auto bytes = before.substr(before.find('\n') + 1);
    return from(head, bytes);
  } catch (const std::exception&) {  // the sum is right, and what it is the sum of is not ours
    refuse_broken(file);
  }
}

void require_question(const checkpoint& state, const json& question, const std::filesystem::path& file) {
  if (state.question == question) return;
  std::string changed;
  for (const auto& [name, value] : question.items()) {
    if (state.question.is_object() && state.question.contains(name) && state.question[name] == value)
      continue;
    changed += changed.empty() ? name : ", " + name;
  }
  refuse("{} is of another run ({}): ask for the same, or name another --checkpoint", file.string(),
         changed.empty() ? "it has more" : changed);
}

void warn_of_version(const checkpoint& state, const std::filesystem::path& file) {
  if (state.version.empty() || state.version == version) return;
  warn(fmt::format("{} was written by nysalt {}, this is {}: what follows may differ in its last digits",
                   file.string(), state.version, version));
}

}  // namespace nysalt::program
