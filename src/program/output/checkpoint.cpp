// SPDX-License-Identifier: BSL-1.0
#include "checkpoint.hpp"

#include <algorithm>
#include <bit>
#include <boost/crc.hpp>
#include <fstream>
#include <iterator>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>

#include "build_info.hpp"
#include "comparison/refusal.hpp"
#include "nysalt/atomic_file.hpp"
#include "program/output.hpp"

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

json head_of(const checkpoint& state) {
  json batch = json::array();
  for (const auto& step : state.at.batch.diverged_at) batch.push_back(step ? json(*step) : json(nullptr));
  json diverged = json::array();
  for (const auto& one : state.lost) diverged.push_back({{"trajectory", one.trajectory}, {"step", one.step}});
  return {{"format", format},
          {"version", format_version},
          {"nysalt", version},
          {"question", state.question},
          {"first", state.at.first},
          {"step", state.at.batch.step},
          {"wave", batch},
          {"diverged", diverged},
          {"output", state.output},
          {"length", state.written.length},
          {"sum", state.written.crc},
          {"in_order", state.in_order},
          {"finished", state.finished}};
}

/// Of json's own conversions, that of a large double is undefined.
std::int64_t count(const json& value) {
  const auto number = value.get_ref<const json::number_integer_t&>();
  if (number < 0) throw std::out_of_range("a count is negative");
  return number;
}

checkpoint state_of(const json& head) {
  checkpoint state;
  state.question = head.at("question");
  state.at.first = count(head.at("first"));
  state.at.batch.step = count(head.at("step"));
  for (const auto& step : head.at("wave")) {
    state.at.batch.diverged_at.push_back(step.is_null() ? std::nullopt : std::optional(count(step)));
  }
  for (const auto& one : head.at("diverged")) {
    state.lost.push_back({count(one.at("trajectory")), count(one.at("step"))});
  }
  state.output = head.value("output", std::string());
  state.written.length = static_cast<std::uint64_t>(count(head.at("length")));
  state.written.crc = static_cast<std::uint32_t>(count(head.at("sum")));
  state.in_order = head.at("in_order").get<bool>();
  state.finished = head.at("finished").get<bool>();
  state.version = head.at("nysalt").get<std::string>();
  return state;
}

/// Throws std::exception for what cannot be of one run.
void require_sound(const checkpoint& state) {
  const std::int64_t trajectories = count(state.question.at("trajectories"));
  const std::int64_t steps = count(state.question.at("steps"));
  const auto& [step, numbers, batch] = state.at.batch;
  const bool is_of_it = std::ranges::all_of(state.lost, [&](const diverged_trajectory& one) {
    return one.trajectory < trajectories && one.step <= steps;
  });
  const bool is_no_cut = step % steps_between_checks != 0 && step != steps;
  if (state.at.first > trajectories - std::ssize(batch) || step > steps || is_no_cut || !is_of_it ||
      numbers.size() % std::max<std::size_t>(batch.size(), 1) != 0) {
    throw std::out_of_range("checkpoint");
  }
}

}  // namespace

void write_checkpoint(const std::filesystem::path& file, const checkpoint& state) {
  const auto numbers = std::as_bytes(std::span(state.at.batch.numbers));
  std::string text = head_of(state).dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
  text.append(reinterpret_cast<const char*>(numbers.data()), numbers.size());
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
  const json head = json::parse(text.substr(0, text.find('\n')), nullptr, false);
  if (!head.is_object() || head.value("format", json()) != format) {
    refuse("{} is no checkpoint of nysalt, or was cut off: name another file", file.string());
  }
  const json file_version = head.value("version", json());
  if (file_version.is_number_integer() && file_version > format_version) {
    refuse("{} was written by a newer nysalt (format {}, this one reads {}): go on with that one",
           file.string(), file_version.dump(), format_version);
  }
  const std::size_t end = text.size() - std::min(text.size(), last_line("").size());
  const auto before = std::string_view(text).substr(0, end);
  try {
    if (!text.ends_with(last_line(before))) throw std::out_of_range("crc32");
    checkpoint state = state_of(head);
    const auto bytes = before.substr(before.find('\n') + 1);
    if (bytes.size() % sizeof(double) != 0) throw std::out_of_range("numbers");
    state.at.batch.numbers.resize(bytes.size() / sizeof(double));
    bytes.copy(reinterpret_cast<char*>(state.at.batch.numbers.data()), bytes.size());
    require_sound(state);
    return state;
  } catch (const std::exception&) {
    refuse("{} is not whole, or was edited: take an older copy, or remove it and begin anew", file.string());
  }
}

void require_question(const checkpoint& state, const json& question, const std::filesystem::path& file) {
  if (state.question == question) return;
  std::string changed;
  for (const auto& [name, value] : question.items()) {
    if (state.question.value(name, json()) == value) continue;
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
