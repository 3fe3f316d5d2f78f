// SPDX-License-Identifier: BSL-1.0
#include "program_run.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "../../../src/comparison/inputs.hpp"
#include "../../../src/program/command_line.hpp"
#include "../../../src/program/run_program.hpp"
#include "../../support/scratch.hpp"

namespace nysalt::fuzz {

namespace fs = std::filesystem;

namespace {

std::array<long, 4> codes{};

/// What is printed to a stream of C while this lives. The descriptor below it stays open, for sanitizers.
class caught {
 public:
  explicit caught(std::FILE*& stream) : stream_(stream), before_(stream) {
    stream_ = open_memstream(&text_, &size_);
    if (stream_ == nullptr) std::abort();
  }
  caught(const caught&) = delete;
  caught& operator=(const caught&) = delete;
  ~caught() {
    std::fclose(stream_);
    stream_ = before_;
    std::free(text_);
  }

  std::string text() const {
    std::fflush(stream_);
    return {text_, size_};
  }

 private:
  std::FILE*& stream_;
  std::FILE* before_;
  char* text_ = nullptr;
  std::size_t size_ = 0;
};

/// Where the program runs: below a folder that is ours too, as a mutated name may be "..".
class playground {
 public:
  playground() : outer_("fuzz"), inner_(outer_ / "folder") {
    fs::create_directory(inner_);
    fs::current_path(inner_);
  }
  ~playground() { fs::current_path("/"); }

  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(inner_)) names.insert(entry.path().filename());
    for (const auto& entry : fs::directory_iterator(outer_.path())) {
      if (entry.path() != inner_) names.insert("../" + entry.path().filename().string());
    }
    return names;
  }
  void remove(const std::string& name) const { fs::remove_all(inner_ / name); }

 private:
  test::scratch outer_;
  fs::path inner_;
};

remains left_by(program::command_line part, std::vector<std::string> words) {
  std::vector<char*> pointers;
  for (auto& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  remains left;
  const caught printed(stdout);
  const caught complained(stderr);
  left.code = program::exit_code_of(part, static_cast<int>(words.size()), pointers.data());
  left.out = printed.text();
  left.err = complained.text();
  return left;
}

[[noreturn]] void tell(const std::string& promise, const std::vector<std::string>& arguments,
                       const remains& left) {
  std::fprintf(stderr, "%s\n ", promise.c_str());
  for (const auto& word : arguments) std::fprintf(stderr, " '%s'", word.c_str());
  std::fprintf(stderr, "\n  exit code %d\n  standard error: %s\n  files:", left.code, left.err.c_str());
  for (const auto& name : left.files) std::fprintf(stderr, " %s", name.c_str());
  std::fprintf(stderr, "\n");
  std::abort();
}

/// The exit code. Words that begin with "nysalt".
int tried(program::command_line part, const std::vector<std::string>& words,
          const std::vector<input_file>& inputs) {
  static const playground folder;
  program::forget_inputs();
  for (const auto& [name, text] : inputs) std::ofstream(name, std::ios::binary) << text;
  const auto before = folder.files();
  remains left = left_by(part, words);
  left.files = folder.files();
  for (const auto& [name, text] : inputs) {
    left.inputs_are_whole = left.inputs_are_whole && test::contents(name) == text;
  }
  const std::string promise = broken_promise(left, before);
  if (!promise.empty()) tell(promise, words, left);
  ++codes[static_cast<std::size_t>(left.code)];
  for (const auto& name : left.files) folder.remove(name);
  return left.code;
}

bool is_one_line(const std::string& text) {
  const auto is_control = [](unsigned char c) { return c < ' '; };
  return text.starts_with("nysalt: ") && text.ends_with('\n') &&
         std::none_of(text.begin(), text.end() - 1, is_control);
}

}  // namespace

std::string broken_promise(const remains& left, const std::set<std::string>& files_before) {
  if (left.code != 0 && left.code != 2 && left.code != 3) return "an exit code that is not 0, 2 or 3";
  const auto is_half_written = [&](const std::string& name) {
    return name.find(".part") != std::string::npos && !files_before.contains(name);
  };
  if (std::any_of(left.files.begin(), left.files.end(), is_half_written)) return "a file is half written";
  if (left.code != 2) return "";
  if (!is_one_line(left.err)) return "a refusal is not one line of plain characters";
  if (!left.out.empty()) return "something is printed beside a refusal";
  if (left.files != files_before || !left.inputs_are_whole) return "a refusal leaves the folder changed";
  return "";
}

void run(const std::vector<std::string>& arguments, const std::vector<input_file>& inputs) {
  std::vector<std::string> words{"nysalt"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  tried(program::run_command_line, words, inputs);
}

bool takes(const std::function<void()>& part, const std::vector<input_file>& inputs) {
  static const std::function<void()>* asked;
  asked = &part;
  const auto ask = [](int, char**) { return (*asked)(), 0; };
  return tried(ask, {"nysalt", "(reading alone)"}, inputs) == 0;
}

const std::array<long, 4>& tally() { return codes; }

}  // namespace nysalt::fuzz
