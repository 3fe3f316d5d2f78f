// SPDX-License-Identifier: BSL-1.0
#include "work_file.hpp"

#include <algorithm>
#include <boost/crc.hpp>
#include <fstream>
#include <string_view>
#include <utility>

#include "all_ranks.hpp"
#include "nysalt/communicator.hpp"
#include "origin.hpp"
#include "refusal.hpp"

namespace nysalt::program {

namespace {

constexpr const char* format_of_work = "nysalt work";
constexpr std::uintmax_t most_text = std::uintmax_t{1} << 28U;  // bytes
constexpr std::uintmax_t most_bytes = most_text + (std::uintmax_t{1} << 30U);
constexpr const char* of_numbers = "numbers";  // the part that says how many there are, and their CRC-32

/// With a checksum as the last member.
std::string line_of(json document) {
  document["checksum"] = checksum(document);
  return document.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
}
std::string line_of(const std::string& part, const json& result) {
  return line_of({{"part", part}, {"result", result}});
}

/// Whether the checksum of a line is that of the line.
bool is_as_written(json line) {
  const json stated = line.value("checksum", json());
  return stated.is_string() && stated == checksum(std::move(line));
}

json sum_of(std::string_view numbers) {
  boost::crc_32_type sum;
  sum.process_bytes(numbers.data(), numbers.size());
  return {numbers.size() / sizeof(double), sum.checksum()};
}

std::string_view bytes_of(std::span<const double> numbers) {
  const auto bytes = std::as_bytes(numbers);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

[[noreturn]] void refuse_foreign(const std::filesystem::path& path) {
  refuse("cannot resume from {}: the file is no work file, or was edited; remove it to begin anew",
         path.string());
}

}  // namespace

void require_no_work(const std::filesystem::path& output) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(output, ignored)) return;
  const std::string begins = fmt::format(R"({{"format":"{}")", format_of_work);
  std::string text(begins.size(), '\0');
  std::ifstream(output, std::ios::binary).read(text.data(), static_cast<std::streamsize>(text.size()));
  if (text != begins) return;
  refuse("cannot write {}: it is the work file of what has not finished; name another file", output.string());
}

work_file::work_file(const std::filesystem::path& file, const json& question, bool resume)
    : path_(nysalt::detail::behind_links(file)) {
  std::string text;
  std::optional<nysalt::atomic_file> next;  // of two that begin at once the second is refused
  on_first(all_ranks(), [&] {
    next.emplace(path_, "next");
    text = text_of_file();
  });
  const std::size_t end = std::min(text.find("\n\n") + 1, text.size());
  const std::string numbers = end == 0 ? std::string() : text.substr(std::min(end + 1, text.size()));
  if (end > 0) text.resize(end);
  broadcast(all_ranks(), text);
  json head{{"format", format_of_work}, {"question", question}};
  head.update(origin());
  head_ = line_of(std::move(head));
  const json stored_question = read(text);
  found_ = lines_.size();
  if (resume && !stored_question.is_null()) require_same_question(stored_question, question, path_);
  if (!resume && found_ > 0) {
    refuse(
        "cannot write {}: the file holds {} finished parts of work that was stopped; resume it, or remove "
        "the file to begin anew",
        path_.string(), found_);
  }
  on_first(all_ranks(), [&] {
    if (sum_of(numbers) != (has(of_numbers) ? result_of(of_numbers) : sum_of({}))) refuse_edited(of_numbers);
    numbers_.resize(numbers.size() / sizeof(double));
    std::ranges::copy(numbers, reinterpret_cast<char*>(numbers_.data()));
    if (found_ == 0) write(*next);
  });
}

work_file::~work_file() {
  if (path_.empty() || held_.number() < 0) return;
  if (is_empty()) remove();
  if (is_written_ || is_empty()) return;
  try {
    nysalt::atomic_file next(path_, "next");
    write(next);
  } catch (const std::exception&) {  // what was written before stays
    if (found_ == 0 && !has_written_parts_) remove();
  }
}

/// What another left there, which this process now holds.
std::string work_file::text_of_file() {
  held_ = nysalt::detail::held(path_);
  if (held_.number() < 0) return {};
  std::error_code failure;
  const auto size = std::filesystem::file_size(path_, failure);
  if (failure || size > most_bytes) {
    refuse("cannot resume from {}: a work file must be at most {} MB long; remove the file to begin anew",
           path_.string(), most_bytes >> 20U);
  }
  std::string text(static_cast<std::size_t>(size), '\0');
  std::ifstream input(path_, std::ios::binary);
  input.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (text.empty() || !input) refuse_foreign(path_);
  return text;
}

void require_same_question(const json& stored_question, const json& asked,
                           const std::filesystem::path& path) {
  const json question = as_kept(asked);
  if (stored_question == question) return;
  std::string changed;
  for (const auto& [name, value] : question.items()) {
    if (stored_question.is_object() && stored_question.contains(name) && stored_question[name] == value)
      continue;
    changed += changed.empty() ? name : ", " + name;
  }
  refuse(
      "cannot resume from {}: the file is of another question ({}); ask the same, or remove the file to "
      "begin anew",
      path.string(), changed.empty() ? "it asks for more" : changed);
}

/// Takes the finished parts from the lines of a file; returns the question, null of no file.
json work_file::read(std::string_view text) {
  constexpr std::size_t most_parts = 100'000;
  json question;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view of_part = text.substr(0, end);
    const json line = end < text.size() ? parsed(of_part) : json();
    if (!line.is_object() || !is_as_written(line)) refuse_foreign(path_);
    if (question.is_null()) {
      if (line.value("format", json()) != format_of_work || !line.value("question", json()).is_object())
        refuse_foreign(path_);
      question = line["question"];
      warning_ = warning_of_origin(line, path_);
    } else {
      if (!line.contains("result") || !line.value("part", json()).is_string() || lines_.size() == most_parts)
        refuse_foreign(path_);
      lines_[line["part"].get<std::string>()] = std::string(of_part) + '\n';
    }
    text.remove_prefix(end + 1);
  }
  return question;
}

json work_file::result_of(const std::string& part) const {
  if (!has(part)) refuse_edited(part);
  return parsed(lines_.at(part)).at("result");
}

void work_file::refuse_edited(const std::string& part) const {
  refuse("cannot resume from {}: the part '{}' is not whole, or was edited; remove the file to begin anew",
         path_.string(), part);
}

bool work_file::is_due() const { return clock::now() - written_at_ >= 20 * writing_; }

void work_file::keep(const std::string& part, json result) {
  name_infinities(result);
  lines_[part] = line_of(part, result);
  is_written_ = false;
  on_first(all_ranks(), [&] {
    if (!is_due()) return;
    nysalt::atomic_file next(path_, "next");
    write(next);
  });
}

void work_file::replace(const std::string& part, const json& result, std::vector<double> numbers) {
  numbers_ = std::move(numbers);
  lines_[part] = line_of(part, result);
  lines_[of_numbers] = line_of(of_numbers, sum_of(bytes_of(numbers_)));
  nysalt::atomic_file next(path_, "next");
  write(next);
}

void work_file::write(nysalt::atomic_file& next) {
  const auto began = clock::now();
  std::uintmax_t text = head_.size();
  for (const auto& [part, line] : lines_) text += line.size();
  if (text > most_text || text + bytes_of(numbers_).size() > most_bytes) {
    refuse(
        "cannot write {}: a work file must hold at most {} MB of text and {} MB in all; take fewer "
        "trajectories",
        path_.string(), most_text >> 20U, most_bytes >> 20U);
  }
  if (held_.number() >= 0 && !nysalt::detail::has_name(held_.number(), path_)) {
    throw nysalt::detail::write_failure(fmt::format(
        "cannot write {}: another process removed or replaced the file; begin again", path_.string()));
  }
  next.write(head_);
  for (const auto& [part, line] : lines_) next.write(line);
  if (!numbers_.empty()) next.write("\n");
  next.write(bytes_of(numbers_));
  if (is_empty() && !name_) name_.emplace(path_);
  if (!is_empty()) name_.reset();
  next.commit(true);
  held_ = next.release();
  is_written_ = true;
  has_written_parts_ = !is_empty();
  written_at_ = clock::now();
  writing_ = written_at_ - began;
}

void work_file::remove() {
  std::error_code ignored;
  if (held_.number() >= 0 && nysalt::detail::has_name(held_.number(), path_))
    std::filesystem::remove(path_, ignored);
  held_ = nysalt::detail::descriptor();
}

}  // namespace nysalt::program
