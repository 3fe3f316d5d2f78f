// SPDX-License-Identifier: BSL-1.0
#include "checkpoint_file.hpp"

#include <algorithm>
#include <bit>
#include <boost/crc.hpp>
#include <fstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include "comparison/journal.hpp"
#include "comparison/origin.hpp"
#include "comparison/refusal.hpp"
#include "nysalt/atomic_file.hpp"

namespace nysalt::program {

namespace {

constexpr const char* format_of_checkpoint = "nysalt checkpoint";
constexpr int version_of_checkpoint = 2;

static_assert(std::endian::native == std::endian::little, "checkpoints hold doubles as this machine does");

std::string last_line(const boost::crc_32_type& sum) {
  return fmt::format("\ncrc32 {:08x}\n", sum.checksum());
}

[[noreturn]] void refuse_foreign(const std::filesystem::path& file) {
  refuse("cannot read {}: the file is no checkpoint of nysalt, or was cut off; name another file",
         file.string());
}

/// The first line, with its end; empty if it is none of ours.
std::string first_line(std::istream& input) {
  std::string line;
  std::string block(std::size_t{1} << 12U, '\0');
  while (line.size() <= longest_document) {
    input.getline(block.data(), static_cast<std::streamsize>(block.size()));
    if (input.eof() || input.bad()) return {};  // no end of a line
    const auto count = static_cast<std::size_t>(input.gcount());
    if (input.good()) return line.append(block, 0, count - 1) + '\n';
    line.append(block, 0, count);  // there is more
    input.clear();
    if (count == 0) return {};
  }
  return {};
}

constexpr std::uintmax_t most_bytes = std::uintmax_t{1} << 30U;  // of numbers

/// Bytes of numbers of a file of that first line. Throws refusal unless they may be read.
std::uintmax_t bytes_of_numbers(const std::filesystem::path& file, std::size_t line) {
  std::error_code failure;
  const std::size_t end = last_line(boost::crc_32_type()).size();
  const std::uintmax_t size = std::filesystem::file_size(file, failure);
  if (failure || size < line + end) refuse_edited_checkpoint(file);
  const std::uintmax_t bytes = size - line - end;
  if (bytes > most_bytes) {
    refuse("cannot read {}: the numbers of a checkpoint must be at most {} MB, got {} MB; name another file",
           file.string(), most_bytes >> 20U, bytes >> 20U);
  }
  if (bytes % sizeof(double) != 0) refuse_edited_checkpoint(file);
  return bytes;
}

/// Whether the last line is of all before it. What was read is the first line.
bool is_whole(std::istream& input, const std::string& line, std::uintmax_t bytes) {
  boost::crc_32_type sum;
  sum.process_bytes(line.data(), line.size());
  std::string block;
  for (std::uintmax_t left = bytes; left > 0 && input; left -= block.size()) {
    block.resize(std::min<std::uintmax_t>(left, std::uintmax_t{1} << 20U));
    input.read(block.data(), static_cast<std::streamsize>(block.size()));
    sum.process_bytes(block.data(), block.size());
  }
  std::string found(last_line(sum).size(), '\0');
  input.read(found.data(), static_cast<std::streamsize>(found.size()));
  return input && found == last_line(sum);
}

}  // namespace

void write_checkpoint_file(const std::filesystem::path& file, const json& head,
                           std::span<const double> numbers, const std::function<void()>& check) {
  json all{{"format", format_of_checkpoint}, {"version", version_of_checkpoint}};
  all.update(origin());
  all.update(head);
  std::string text = all.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
  const auto bytes = std::as_bytes(numbers);
  if (bytes.size() > most_bytes || !may_be_parsed(text)) {
    refuse(
        "cannot write {}: a checkpoint must hold at most {} MB of numbers and {} MB of text, got {} and {} "
        "MB; take fewer trajectories, or leave --checkpoint out",
        file.string(), most_bytes >> 20U, longest_document >> 20U, bytes.size() >> 20U, text.size() >> 20U);
  }
  text.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  boost::crc_32_type sum;
  sum.process_bytes(text.data(), text.size());
  text += last_line(sum);
  atomic_file out(file, "next");
  if (check) check();
  out.write(text);
  out.commit(true);
}

void require_no_checkpoint(const std::filesystem::path& output) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(output, ignored)) return;
  std::ifstream input(output, std::ios::binary);
  const json head = parsed(first_line(input));
  if (!head.is_object()) return;
  const json format = head.value("format", json());
  if (format == format_of_journal) {
    refuse("cannot write {}: it is the journal of a comparison that has not finished; name another file",
           output.string());
  }
  if (format != format_of_checkpoint || head.value("finished", json()) == true) return;
  refuse("cannot write {}: it is a checkpoint of what has not finished; name another file", output.string());
}

json head_of_checkpoint(const std::filesystem::path& file, const std::string& command) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    refuse("cannot resume from {}: there is no such checkpoint; leave --resume out to begin", file.string());
  }
  if (!std::filesystem::is_regular_file(file, ignored)) refuse_foreign(file);
  std::ifstream input(file, std::ios::binary);
  const std::string line = first_line(input);
  json head = parsed(line);
  if (!head.is_object() || head.value("format", json()) != format_of_checkpoint) refuse_foreign(file);
  const json file_version = head.value("version", json());
  if (!file_version.is_number()) refuse_edited_checkpoint(file);
  if (file_version > version_of_checkpoint) {
    refuse(
        "cannot read {}: a newer nysalt wrote the checkpoint (format {}, this one reads {}); go on with that "
        "nysalt",
        file.string(), file_version.dump(), version_of_checkpoint);
  }
  if (!is_whole(input, line, bytes_of_numbers(file, line.size()))) refuse_edited_checkpoint(file);
  const json of_command = head.value("command", json("run"));  // older ones do not say
  if (of_command != command) {
    refuse("{} must be a checkpoint of nysalt {}, got {}; name another file", file.string(), command,
           of_command.is_string() ? of_command.get<std::string>() : "another kind");
  }
  return head;
}

std::vector<double> numbers_of_checkpoint(const std::filesystem::path& file, std::size_t count) {
  std::ifstream input(file, std::ios::binary);
  const std::uintmax_t bytes = bytes_of_numbers(file, first_line(input).size());
  if (bytes / sizeof(double) != count) refuse_edited_checkpoint(file);
  std::vector<double> numbers(count);
  input.read(reinterpret_cast<char*>(numbers.data()), static_cast<std::streamsize>(bytes));
  if (!input) refuse_edited_checkpoint(file);
  return numbers;
}

void refuse_edited_checkpoint(const std::filesystem::path& file) {
  refuse(
      "cannot read {}: the checkpoint is not whole, or was edited; take an older copy, or remove the file "
      "and begin anew",
      file.string());
}

std::int64_t count_in(const json& value) {
  const auto number = value.get_ref<const json::number_integer_t&>();
  if (number < 0) throw std::out_of_range("a count must not be negative");
  return number;
}

void require_question(const json& asked_then, const json& asked, const std::filesystem::path& file) {
  const json question = as_kept(asked);
  if (asked_then == question) return;
  std::string changed;
  for (const auto& [name, value] : question.items()) {
    if (asked_then.value(name, json()) == value) continue;
    changed += changed.empty() ? name : ", " + name;
  }
  refuse(
      "{} must be a checkpoint of this run, got that of another run ({}); ask for the same, or name another "
      "--checkpoint",
      file.string(), changed.empty() ? "it has more" : changed);
}

}  // namespace nysalt::program
