// SPDX-License-Identifier: BSL-1.0
#include "journal.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <fstream>
#include <string_view>

#include "all_ranks.hpp"
#include "nysalt/atomic_file.hpp"
#include "nysalt/communicator.hpp"
#include "origin.hpp"
#include "refusal.hpp"

namespace nysalt::program {

namespace {

/// With a checksum as the last member.
std::string line_of(json document) {
  document["checksum"] = checksum(document);
  return document.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
}

json first_line(const json& question) {
  json line{{"format", format_of_journal}, {"question", question}};
  line.update(origin());
  return line;
}

/// Whether the checksum of a line is that of the line.
bool is_as_written(json line) {
  const json stated = line.value("checksum", json());
  return stated.is_string() && stated == checksum(std::move(line));
}

}  // namespace

journal::journal(const std::filesystem::path& file, const json& question, bool resume) : path_(file) {
  std::string text;
  on_first(all_ranks(), [&] { text = open_file(); });
  broadcast(all_ranks(), text);
  const std::string head = line_of(first_line(question));
  const std::size_t whole = read(text, question, head);
  if (!resume && !found_.empty()) {
    refuse(
        "cannot write {}: the file holds {} finished parts of a run that was stopped; take {}, or remove the "
        "file",
        path_.string(), found_.size(), switched_on("resume"));
  }
  on_first(all_ranks(), [&] {
    if (ftruncate(fileno(file_.get()), static_cast<off_t>(whole)) != 0) {
      throw nysalt::detail::write_failure(
          fmt::format("cannot write {}: the system does not shorten the file; name another {}",
                      path_.string(), spelled("output")));
    }
    std::fseek(file_.get(), 0, SEEK_END);
    if (whole == 0) write(head);
  });
}

/// Opens and locks the file; returns its contents.
std::string journal::open_file() {
  std::error_code ignored;
  if (std::filesystem::exists(path_, ignored) && !std::filesystem::is_regular_file(path_, ignored)) {
    refuse("cannot write {}: it is not a regular file; name another {}", path_.string(), spelled("output"));
  }
  const int descriptor = open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0) {
    throw nysalt::detail::write_failure(fmt::format(
        "cannot write {}: the folder or the file is not writable, or the disk is full; name another {}",
        path_.string(), spelled("output")));
  }
  file_.reset(fdopen(descriptor, "r+"));
  if (nysalt::detail::ask_for_lock(descriptor) == nysalt::detail::lock_outcome::held_by_another) {
    refuse("cannot write {}: another run is writing it; wait for that run, or name another {}",
           path_.string(), spelled("output"));
  }
  constexpr std::uintmax_t most = std::uintmax_t{1} << 28U;  // bytes
  const auto size = std::filesystem::file_size(path_, ignored);
  if (ignored || size > most) {
    refuse("cannot resume from {}: a journal must be at most {} MB long; remove the file to begin anew",
           path_.string(), most >> 20U);
  }
  std::string text(static_cast<std::size_t>(size), '\0');
  std::ifstream input(path_, std::ios::binary);
  input.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(input.gcount()));
  return text;
}

namespace {

[[noreturn]] void refuse_foreign(const std::filesystem::path& path) {
  refuse("cannot resume from {}: the file is no journal, or was edited; remove it to begin anew",
         path.string());
}

}  // namespace

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

/// Takes the finished parts from the text of a journal; returns the length of its whole lines.
std::size_t journal::read(const std::string& text, const json& question, const std::string& head) {
  constexpr std::size_t most_parts = 100'000;
  std::size_t at = 0;
  for (std::size_t end = 0; (end = text.find('\n', at)) != std::string::npos; at = end + 1) {
    const auto of_part = std::string_view(text).substr(at, end - at);
    json line = parsed(of_part);
    if (at == 0) {
      if (!line.is_object() || line.value("format", json()) != format_of_journal ||
          !line.contains("question") || !is_as_written(line)) {
        refuse_foreign(path_);
      }
      require_same_question(line["question"], question, path_);
      warning_ = warning_of_origin(line, path_);
      continue;
    }
    if (!line.is_object() || !line.contains("result") || !line.value("part", json()).is_string() ||
        found_.size() == most_parts) {
      refuse_foreign(path_);
    }
    found_[line["part"].get<std::string>()] = of_part;
    if (!is_as_written(std::move(line))) refuse_foreign(path_);
  }
  // A line that was cut off: of ours, if it is the first.
  if (at == 0 && !head.starts_with(text)) refuse_foreign(path_);
  return at;
}

json journal::result_of(const std::string& part) const { return parsed(found_.at(part)).at("result"); }

void journal::refuse_edited(const std::string& part) const {
  refuse("cannot resume from {}: the part '{}' is not whole, or was edited; remove the file to begin anew",
         path_.string(), part);
}

void journal::keep(const std::string& part, json result) {
  name_infinities(result);
  on_first(all_ranks(), [&] { write(line_of({{"part", part}, {"result", result}})); });
  has_written_ = true;
}

void journal::write(const std::string& text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), file_.get()) == text.size();
  if (!written || std::fflush(file_.get()) != 0) {
    throw nysalt::detail::write_failure(
        fmt::format("cannot write {}: the disk may be full; free space on it, then take {}, which keeps the "
                    "finished parts",
                    path_.string(), switched_on("resume")));
  }
}

void journal::remove() {
  if (!file_) return;
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
  file_.reset();
}

}  // namespace nysalt::program
