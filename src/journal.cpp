// SPDX-License-Identifier: BSL-1.0
#include "journal.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <string_view>

#include "refusal.hpp"

namespace nysalt::program {

namespace {
constexpr const char* format = "nysalt journal";
}

journal::journal(const std::filesystem::path& file, const json& question, bool resume) : path_(file) {
  const int descriptor = open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0)
    refuse("cannot write {}: is the folder writable, and the disk not full?", path_.string());
  file_.reset(fdopen(descriptor, "r+"));
  if (flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    refuse("{} is being written by another run: wait for it, or name another --output", path_.string());
  }
  const std::size_t whole = read(question);
  if (!resume && !found_.empty()) {
    refuse("{} holds {} finished parts of a run that was stopped: --resume goes on, or remove the file",
           path_.string(), found_.size());
  }
  if (ftruncate(descriptor, static_cast<off_t>(whole)) != 0) refuse("cannot write {}", path_.string());
  std::fseek(file_.get(), 0, SEEK_END);
  if (whole == 0) write({{"format", format}, {"question", question}});
}

/// The length of its whole lines.
std::size_t journal::read(const json& question) {
  std::ifstream input(path_, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(input), {}};
  std::size_t at = 0;
  for (std::size_t end = 0; (end = text.find('\n', at)) != std::string::npos; at = end + 1) {
    const json line = json::parse(std::string_view(text).substr(at, end - at), nullptr, false);
    const bool is_head = at == 0 && line.is_object() && line.value("format", "") == format;
    const bool is_part = at > 0 && line.is_object() && line.contains("part") && line.contains("result");
    if (!is_head && !is_part) {
      refuse("{} is no journal, or was edited: remove it to begin anew", path_.string());
    }
    if (is_part) {
      found_[line["part"].get<std::string>()] = line["result"];
      continue;
    }
    if (line["question"] == question) continue;
    std::string changed;
    for (const auto& [name, value] : question.items()) {
      if (line["question"].contains(name) && line["question"][name] == value) continue;
      changed += changed.empty() ? name : ", " + name;
    }
    refuse("{} is of another question ({}): ask the same, or remove the file to begin anew", path_.string(),
           changed.empty() ? "it asks for more" : changed);
  }
  return at;
}

void journal::keep(const std::string& part, const json& result) {
  if (file_) write({{"part", part}, {"result", result}});
}

void journal::write(const json& line) {
  const std::string text = line.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
  const bool written = std::fwrite(text.data(), 1, text.size(), file_.get()) == text.size();
  if (!written || std::fflush(file_.get()) != 0) {
    throw journal_failure(fmt::format(
        "cannot write {}: is the disk full? What is in it counts when you --resume", path_.string()));
  }
}

void journal::remove() {
  if (!file_) return;
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
  file_.reset();
}

}  // namespace nysalt::program
