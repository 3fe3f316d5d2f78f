// SPDX-License-Identifier: BSL-1.0
// Feeds a fuzz target with mutations of a corpus, the same ones for the same seed with any compiler:
//   fuzz_TARGET CORPUS RUNS [SEED [FIRST]]
// Input n depends on the seed and n alone, so that an input that breaks a promise comes again as the first of
//   fuzz_TARGET CORPUS 1 SEED n
// libFuzzer, which is led by what the program does with an input, drives the same targets: ./dev check fuzz.
#include <signal.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "../../support/scratch.hpp"
#include "program_run.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

constexpr int most_seconds = 300;  // of computing for one input, by a program that is built to be examined

using texts = std::vector<std::string>;

char what_it_was[200];  // ready to be written by a handler of signals

void tell_and_end(int signal) {
  const char* what = signal == SIGPROF ? "an input takes too long\n" : "";
  for (const char* text : {what, static_cast<const char*>(what_it_was)}) {
    if (write(STDERR_FILENO, text, std::strlen(text)) < 0) break;
  }
  std::signal(signal, SIG_DFL);
  raise(signal);
}

texts texts_in(const std::string& folder) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  texts all;
  for (const auto& path : paths) all.push_back(nysalt::test::contents(path));
  return all;
}

std::uint64_t number(const char* text) {
  std::uint64_t value = 0;
  const char* const end = text + std::strlen(text);
  if (std::from_chars(text, end, value).ptr == end) return value;
  std::fprintf(stderr, "'%s' is not a whole number\n", text);
  std::exit(2);
}

using part = std::pair<std::size_t, std::size_t>;  // of a text: first byte, length
using parts = std::vector<part>;

parts runs_of(const std::string& text, auto&& belongs) {
  parts found;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::size_t first = i;
    while (i < text.size() && belongs(static_cast<unsigned char>(text[i]))) ++i;
    if (i > first) found.emplace_back(first, i - first);
  }
  return found;
}

parts lines_of(const std::string& text) {
  return runs_of(text, [](unsigned char c) { return c != '\n'; });
}

struct dice {
  std::mt19937_64 bits;
  /// 0 .. n - 1. The bias of the remainder does not matter here.
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(bits() % n); }
  const auto& one_of(const auto& all) { return all[below(std::size(all))]; }
};

void swap_two(std::string& text, const parts& all, dice& random) {
  part one = random.one_of(all), other = random.one_of(all);
  if (one == other) return;
  if (one > other) std::swap(one, other);
  const std::string first = text.substr(one.first, one.second);
  const std::string second = text.substr(other.first, other.second);
  text.replace(other.first, other.second, first);  // the later one first, so that the earlier stays in place
  text.replace(one.first, one.second, second);
}

/// Small damage to a text, as typing, cutting and copying do it: bytes flipped, inserted or cut out, lines
/// lost, doubled, swapped or taken from another text, names exchanged, numbers replaced by what is no number,
/// zero or too large. Numbers twice as often: they are where the program computes.
void damage(std::string& text, const texts& corpus, dice& random) {
  constexpr std::string_view telling("\"'{}[],:=#-@\\\n\0", 15);
  static const std::string strange =
      "nan inf -inf 1e999 -0 0 -1 1 1e308 1e-308 5e-324 0.5 -0.5 2 3 9223372036854775807 9223372036854775808 "
      "18446744073709551616 1e17 0x10 1e null";
  static const parts strange_numbers = runs_of(strange, [](unsigned char c) { return c != ' '; });
  const parts lines = lines_of(text);
  const parts names = runs_of(text, [](unsigned char c) { return std::isalpha(c) != 0 || c == '_'; });
  const parts numbers = runs_of(text, [](unsigned char c) { return std::isdigit(c) != 0 || c == '.'; });
  const std::size_t place = random.below(text.size() + 1);
  const std::size_t kind = random.below(11);
  if (kind == 0 && place < text.size()) text[place] = static_cast<char>(text[place] ^ (1 << random.below(8)));
  if (kind == 1) {
    const bool any = random.below(2) == 0;
    text.insert(place, 1, any ? static_cast<char>(random.below(256)) : random.one_of(telling));
  }
  if (kind == 2) text.resize(place);
  if (kind == 3) text.erase(place, 1 + random.below(16));
  if (kind >= 4 && kind <= 7 && !lines.empty()) {
    const auto [first, length] = random.one_of(lines);
    const std::string& other = kind == 6 ? random.one_of(corpus) : text;
    const parts lines_to_take = lines_of(other);
    if (kind == 4) text.erase(first, length + 1);
    if (kind == 7) swap_two(text, lines, random);
    if ((kind == 5 || kind == 6) && !lines_to_take.empty()) {
      const auto [from, count] = random.one_of(lines_to_take);
      text.insert(first, other.substr(from, count) + "\n");
    }
  }
  if (kind == 8 && !names.empty()) swap_two(text, names, random);
  if (kind >= 9 && !numbers.empty()) {
    const auto [first, length] = random.one_of(numbers);
    const auto [from, count] = random.one_of(strange_numbers);
    text.replace(first, length, strange, from, count);
  }
}

void give(const std::string& text) {
  const itimerval limit{{0, 0}, {most_seconds, 0}};
  setitimer(ITIMER_PROF, &limit, nullptr);
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3 || argc > 5) {
    std::fprintf(stderr, "usage: %s CORPUS RUNS [SEED [FIRST]]\n", argv[0]);
    return 2;
  }
  const auto corpus = texts_in(argv[1]);
  const std::uint64_t runs = number(argv[2]);
  const std::uint64_t seed = argc > 3 ? number(argv[3]) : 20260721;
  const std::uint64_t first = argc > 4 ? number(argv[4]) : 0;
  for (const int signal : {SIGABRT, SIGSEGV, SIGFPE, SIGBUS, SIGILL, SIGPROF}) {
    std::signal(signal, tell_and_end);
  }
  const auto began = std::chrono::steady_clock::now();
  std::snprintf(what_it_was, sizeof what_it_was, "one of the corpus itself\n");
  if (first == 0) {
    for (const auto& text : corpus) give(text);
  }
  for (std::uint64_t n = first; n < first + runs; ++n) {
    std::seed_seq words{seed, n};
    dice random{std::mt19937_64(words)};
    std::snprintf(what_it_was, sizeof what_it_was, "this was input %llu of seed %llu\n",
                  static_cast<unsigned long long>(n), static_cast<unsigned long long>(seed));
    std::string text = corpus[static_cast<std::size_t>(n) % corpus.size()];
    for (std::size_t left = 1 + random.below(4); left > 0; --left) damage(text, corpus, random);
    give(text);
  }
  const auto& codes = nysalt::fuzz::tally();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - began;
  std::printf(
      "seed %llu: %llu inputs of a corpus of %zu, in %.1f s; %ld runs ended with 0, %ld with 2, %ld with 3\n",
      static_cast<unsigned long long>(seed), static_cast<unsigned long long>(runs), corpus.size(),
      seconds.count(), codes[0], codes[2], codes[3]);
  // Many inputs of which none is taken, or none refused, do not try what they are to try.
  return runs < 100 || (codes[0] > 0 && codes[2] > 0) ? 0 : 1;
}
