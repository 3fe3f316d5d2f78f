// SPDX-License-Identifier: BSL-1.0
// Checkpoints that a run is to go on from: as they are, which their sum refuses, and with a sum that fits.
#include <cstddef>
#include <cstdint>
#include <string>

#include "../../support/forged.hpp"
#include "program/output/checkpoint.hpp"
#include "program/output/checkpoint_file.hpp"
#include "program_run.hpp"

namespace {

/// What the run of the corpus had written when it was stopped at step 64 of 70.
const nysalt::fuzz::input_file under_way{"out.csv.part",
                                         "trajectory,step,t,energy\n"
                                         "0,0,0,1\n0,40,0.8,1\n1,0,0,1\n1,40,0.8,1\n2,0,0,1\n2,40,0.8,1\n"
                                         "3,0,0,1\n3,40,0.8,1\n4,0,0,1\n4,40,0.8,1\n"};
const nysalt::fuzz::input_file finished{"out.csv", "trajectory,step,t,energy\n0,0,0,1\n"};

void read_whole(const std::string& file) {
  using namespace nysalt::program;
  const json head = head_of_checkpoint(file, "run");
  read_checkpoint(file, head.value("question", json()), 1);
}

/// The readers of all texts, and the command, which takes many times as long, of some.
void go_on(const std::string& text) {
  const nysalt::fuzz::input_file last{"last.checkpoint", text};
  const bool is_taken = nysalt::fuzz::takes([&] { read_whole(last.name); }, {last});
  if (!nysalt::fuzz::is_one_in(is_taken ? 16 : 256, text)) return;
  const std::vector<std::string> asked{
      "run",     "--system",       "pendulum", "--friction",    "0.1",     "--temperature",
      "0.5",     "--start",        "law",      "--method",      "baoab",   "--step",
      "0.02",    "--horizon",      "1.4",      "--observables", "energy",  "--trajectories",
      "5",       "--sample-every", "40",       "--every",       "64",      "--output",
      "out.csv", "--threads",      "1",        "--checkpoint",  last.name, "--resume"};
  std::vector<nysalt::fuzz::input_file> files{last, under_way};
  if (text.size() % 2 == 0) files.push_back(finished);
  nysalt::fuzz::run(asked, files);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  go_on(text);
  go_on(nysalt::test::signed_again(text));
  return 0;
}
