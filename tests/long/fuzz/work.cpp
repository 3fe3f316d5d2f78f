// SPDX-License-Identifier: BSL-1.0
// Work files that a run is to go on from: as they are, which their checksums refuse, and signed again.
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>

#include "../../support/forged.hpp"
#include "comparison/work_file.hpp"
#include "program/output/run_state.hpp"
#include "program_run.hpp"

namespace {

/// What the run of the corpus had written when it was stopped at step 64 of 70.
const nysalt::fuzz::input_file under_way{"out.csv.part",
                                         "trajectory,step,t,energy\n"
                                         "0,0,0,1\n0,40,0.8,1\n1,0,0,1\n1,40,0.8,1\n2,0,0,1\n2,40,0.8,1\n"
                                         "3,0,0,1\n3,40,0.8,1\n4,0,0,1\n4,40,0.8,1\n"};
const nysalt::fuzz::input_file finished{"out.csv", "trajectory,step,t,energy\n0,0,0,1\n"};

/// With the checksums that the lines ought to have.
std::string signed_again(const std::string& text) {
  std::istringstream lines(text);
  std::string result;
  std::string line;
  while (std::getline(lines, line) && !line.empty()) result += nysalt::test::signed_line(line) + '\n';
  const auto numbers = text.find("\n\n");
  return numbers == std::string::npos ? result : result + text.substr(numbers + 1);
}

void read_whole(const std::string& file, const std::string& text) {
  using namespace nysalt::program;
  const json head = parsed(text.substr(0, text.find('\n')));
  const work_file work(file, head.is_object() ? head.value("question", json()) : json(), true);
  saved_in(work, 70, 5, 1);
}

/// The readers of all texts, and the command, which takes many times as long, of some.
void go_on(const std::string& text) {
  const nysalt::fuzz::input_file last{"out.csv.work", text};
  const bool is_taken = nysalt::fuzz::takes([&] { read_whole(last.name, text); }, {last});
  if (!nysalt::fuzz::is_one_in(is_taken ? 16 : 256, text)) return;
  const std::vector<std::string> asked{
      "run",     "--system",       "pendulum", "--friction",    "0.1",    "--temperature",
      "0.5",     "--start",        "law",      "--method",      "baoab",  "--step",
      "0.02",    "--horizon",      "1.4",      "--observables", "energy", "--trajectories",
      "5",       "--sample-every", "40",       "--every",       "64",     "--output",
      "out.csv", "--threads",      "1",        "--resume"};
  std::vector<nysalt::fuzz::input_file> files{last, under_way};
  if (text.size() % 2 == 0) files.push_back(finished);
  nysalt::fuzz::run(asked, files);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  go_on(text);
  go_on(signed_again(text));
  return 0;
}
