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
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "../../support/scratch.hpp"
#include "mutation.hpp"
#include "program_run.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

constexpr int most_seconds = 300;  // of computing for one input, by a program that is built to be examined

char what_it_was[200];  // ready to be written by a handler of signals

void tell_and_end(int signal) {
  const char* what = signal == SIGPROF ? "an input takes too long\n" : "";
  for (const char* text : {what, static_cast<const char*>(what_it_was)}) {
    if (write(STDERR_FILENO, text, std::strlen(text)) < 0) break;
  }
  std::signal(signal, SIG_DFL);
  raise(signal);
}

std::vector<std::string> texts_in(const std::string& folder) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> texts;
  for (const auto& path : paths) texts.push_back(nysalt::test::contents(path));
  return texts;
}

std::uint64_t number(const char* text) {
  std::uint64_t value = 0;
  const char* const end = text + std::strlen(text);
  if (std::from_chars(text, end, value).ptr == end) return value;
  std::fprintf(stderr, "'%s' is not a whole number\n", text);
  std::exit(2);
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
    std::mt19937_64 bits(words);
    std::snprintf(what_it_was, sizeof what_it_was, "this was input %llu of seed %llu\n",
                  static_cast<unsigned long long>(n), static_cast<unsigned long long>(seed));
    give(nysalt::fuzz::mutated(corpus[static_cast<std::size_t>(n) % corpus.size()], corpus, bits));
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
