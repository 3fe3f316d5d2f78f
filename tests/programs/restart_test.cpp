// SPDX-License-Identifier: BSL-1.0
// A run that was killed goes on from its checkpoint to the same bytes; what cannot be gone on with is
// refused.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "../support/killed.hpp"
#include "../support/program.hpp"
#include "../support/without_times.hpp"

using namespace nysalt::test;

namespace {

// Noise, several blocks of lanes, and more than one sample between two checkpoints.
const std::string in_bath =
    "run --system fpu --friction 0.01 --sigma 0.05 --method baoab --step 0.01 --horizon 400 --trajectories "
    "37 "
    "--sample-every 70 --observables stiff_energy,q1,p6 ";
// Some of them diverge, at several steps.
const std::string with_losses =
    "run --system henon_heiles --spread 2.5 --method verlet --step 0.3 --horizon 6000 --trajectories 40 "
    "--sample-every 7 ";
const std::string alone =
    "run --system pendulum --method srkn6b --step 0.1 --horizon 4000 --sample-every 10 ";

const std::string processed =
    "run --system pendulum --method takahashi_imada_processed --step 0.1 --horizon 4000 --sample-every 10 ";

std::string with_checkpoint(const std::string& line, const std::string& name, int every = 100) {
  return line + "--output " + name + ".csv --checkpoint " + name + ".checkpoint --every " +
         std::to_string(every) + " ";
}

std::string whole(const scratch& folder, const std::string& line) {
  const auto done = run(folder, line + "--output whole.csv");
  BOOST_TEST_REQUIRE(done.code == 0, line << ": " << done.err);
  return contents(folder / "whole.csv");
}

void refused(const scratch& folder, const std::string& arguments, const std::string& why) {
  const auto before = folder.files();
  const auto done = run(folder, arguments);
  BOOST_TEST(done.code == 2, arguments << " ended with " << done.code);
  BOOST_TEST(done.err.find(why) != std::string::npos, arguments << " said " << done.err);
  BOOST_TEST(std::count(done.err.begin(), done.err.end(), '\n') == 1, done.err);
  BOOST_TEST((folder.files() == before), arguments << " left something");
}

}  // namespace

BOOST_AUTO_TEST_CASE(killed_again_and_again_it_comes_to_the_same_bytes) {
  for (const auto& line : {in_bath, with_losses, alone, processed}) {
    const scratch folder("restart");
    const std::string expected = whole(folder, line);
    const std::string command = with_checkpoint(line, "cut");
    BOOST_TEST(killed_at(folder, command, "cut.checkpoint", 500));
    BOOST_TEST(!std::filesystem::exists(folder / "cut.csv"));
    BOOST_TEST(std::filesystem::exists(folder / "cut.csv.part"));
    BOOST_TEST(killed_at(folder, command + "--resume --threads 1", "cut.checkpoint", 1200));
    const auto done = run(folder, with_checkpoint(line, "cut", 5000) + "--resume --threads 2");
    BOOST_TEST_REQUIRE(done.code == 0, done.err);
    BOOST_TEST((contents(folder / "cut.csv") == expected), line);
    BOOST_TEST(!std::filesystem::exists(folder / "cut.csv.part"));
  }
}

BOOST_AUTO_TEST_CASE(killed_at_random_moments_it_comes_to_the_same_bytes) {
  const scratch folder("restart_random");
  const auto began = std::chrono::steady_clock::now();
  const std::string expected = whole(folder, in_bath);
  const std::chrono::duration<double> of_all = std::chrono::steady_clock::now() - began;
  std::uint64_t seed = std::random_device()();
  std::minstd_rand random(static_cast<std::minstd_rand::result_type>(seed));
  int kills = 0;
  for (int n = 0; n < 20; ++n) {
    const bool is_there = std::filesystem::exists(folder / "cut.checkpoint");
    const double share = static_cast<double>(random()) / static_cast<double>(random.max());
    const double seconds = of_all.count() * (0.2 + share);
    // --foreground: timeout itself is not killed, and waits until the lock of the killed process is free.
    const auto done = shell(folder, "timeout --foreground -s KILL " + std::to_string(seconds) +
                                        " \"$nysalt\" " + with_checkpoint(in_bath, "cut") +
                                        (is_there ? "--resume" : "") + " >/dev/null 2>&1");
    kills += done.code == 137 ? 1 : 0;
  }
  BOOST_TEST_CONTEXT("seed " << seed << ", " << kills << " kills") {
    BOOST_TEST(kills > 0);
    const bool is_there = std::filesystem::exists(folder / "cut.checkpoint");
    const auto done = run(folder, with_checkpoint(in_bath, "cut", 5000) + (is_there ? "--resume" : ""));
    BOOST_TEST_REQUIRE(done.code == 0, done.err);
    BOOST_TEST((contents(folder / "cut.csv") == expected));
  }
}

// Bytes that are no UTF-8, which a checkpoint in JSON cannot hold.
BOOST_AUTO_TEST_CASE(an_output_may_have_any_name) {
  for (const std::string kind : {".csv", ".npy", ".h5"}) {
    const scratch folder("restart_name");
    if (run(folder, alone + "--output whole" + kind).err.find("built without HDF5") != std::string::npos)
      continue;
    const std::string name = "o\xff" + kind;
    const std::string command = alone + "--checkpoint c --every 100 --output ";
    BOOST_TEST(killed_at(folder, command + name, "c", 500));
    refused(folder, command + "o" + kind + " --resume", "--output must be o");
    const auto done = run(folder, command + name + " --resume");
    BOOST_TEST(done.code == 0, done.err);
    BOOST_TEST((contents(folder / name) == contents(folder / ("whole" + kind))), kind);
  }
}

BOOST_AUTO_TEST_CASE(a_run_of_other_noise_has_other_bytes) {
  const scratch folder("restart_other");
  BOOST_TEST((whole(folder, in_bath) != whole(folder, in_bath + "--seed 2 ")));
}

BOOST_AUTO_TEST_CASE(uncut_with_a_checkpoint_it_has_the_bytes_and_the_document_of_one_without) {
  const scratch folder("restart_uncut");
  const std::string expected = whole(folder, with_losses);
  const auto plain = run(folder, with_losses + "--output cut.csv --json");
  const auto done = run(folder, with_checkpoint(with_losses, "cut", 1000) + "--json");
  BOOST_TEST_REQUIRE(done.code == 0, done.err);
  BOOST_TEST((contents(folder / "cut.csv") == expected));
  BOOST_TEST(without_times(done.out) == without_times(plain.out));
  BOOST_TEST(json_of(done)["diverged"].size() > 2U);  // else it would say little
}

BOOST_AUTO_TEST_CASE(a_finished_run_ends_well_and_is_left_alone) {
  const scratch folder("restart_finished");
  const std::string command = with_checkpoint(with_losses, "cut", 10000);
  const auto first = run(folder, command + "--json");
  std::ofstream(folder / "cut.csv", std::ios::app) << "a note of the user's\n";
  const std::string output = contents(folder / "cut.csv");
  const auto again = run(folder, command + "--json --resume");
  BOOST_TEST(again.code == 0, again.err);
  BOOST_TEST(without_times(again.out) == without_times(first.out));
  BOOST_TEST(contents(folder / "cut.csv") == output);
  const auto told = run(folder, command + "--resume");
  BOOST_TEST(told.out.find("finished already") != std::string::npos, told.out);
  BOOST_TEST(told.err.find("cut.csv was changed after") != std::string::npos, told.err);
  std::ofstream(folder / "other.csv") << "hello";
  refused(folder, with_checkpoint(with_losses, "other", 10000) + "--resume", "there is no such checkpoint");
  std::filesystem::copy(folder / "cut.checkpoint", folder / "other.checkpoint");
  refused(folder, with_checkpoint(with_losses, "other", 10000) + "--resume", "--output must be cut.csv");
  std::filesystem::remove(folder / "cut.csv");
  refused(folder, command + "--resume", "there is no cut.csv");
  // Starts that it takes work to find are not looked for.
  const std::string warm =
      with_checkpoint("run --temperature 1 --friction 1 --method baoab --step 0.01 --horizon 1 ", "warm");
  BOOST_TEST(run(folder, warm).code == 0);
  BOOST_TEST(run(folder, warm + "--resume").code == 0);
}

BOOST_AUTO_TEST_CASE(what_is_half_asked_is_refused) {
  const scratch folder("restart_asked");
  refused(folder, alone + "--output a.csv --resume", "--resume must come with --checkpoint");
  refused(folder, alone + "--output a.csv --every 10", "--every must come with --checkpoint");
  refused(folder, alone + "--output a.csv --checkpoint c", "--checkpoint must come with --every");
  refused(folder, alone + "--checkpoint c --every 10", "--checkpoint must come with --output");
  refused(folder, alone + "--output a.csv --checkpoint c --every 0", "--every must be at least 1");
  refused(folder, alone + "--output a.csv --checkpoint ./a.csv --every 10", "name another file");
  refused(folder, alone + "--output a.csv --checkpoint a.csv.part --every 10", "name another file");
  refused(folder, alone + "--output c.next --checkpoint c --every 10", "name another file");
  refused(folder, alone + "--output a.csv --checkpoint manifest.json --every 10", "name another file");
  refused(folder, alone + "--plot --output a.csv --checkpoint a.svg --every 10", "name another file");
  refused(folder, alone + "--output a.csv --checkpoint none/c --every 10", "there is no folder none");
  refused(folder, with_checkpoint(alone, "cut") + "--resume",
          "cannot resume from cut.checkpoint: there is no such checkpoint");
  BOOST_TEST(folder.files().empty());
}

BOOST_AUTO_TEST_CASE(checkpoints_that_are_not_whole_foreign_or_newer_are_refused_and_left_alone) {
  const scratch folder("restart_refused");
  const std::string command = with_checkpoint(in_bath, "cut");
  BOOST_TEST_REQUIRE(killed_at(folder, command, "cut.checkpoint", 300));
  const std::string file = folder / "cut.checkpoint";
  const std::string part = folder / "cut.csv.part";
  const std::string sound = contents(file);
  const auto try_out = [&](const std::string& text, const std::string& why) {
    std::ofstream(file, std::ios::binary) << text;
    refused(folder, command + "--resume", why);
    if (text != sound) refused(folder, command, why);  // nor begins it anew over somebody's file
    BOOST_TEST((contents(file) == text));
  };
  refused(folder, command, "take --resume to go on with the run");
  refused(folder, in_bath + "--output cut.csv --checkpoint another --every 100",
          "a run that was stopped left it");
  for (const std::size_t length : {sound.size() - 1, sound.size() / 2, sound.find('\n') + 1}) {
    try_out(sound.substr(0, length), "not whole, or was edited");
  }
  for (const std::size_t at : {sound.size() / 2, sound.find("\"seed\"") + 7, sound.size() - 3}) {
    std::string edited = sound;
    edited[at] = static_cast<char>(edited[at] ^ 1);
    try_out(edited, "not whole, or was edited");
  }
  std::string newer = sound;
  newer.replace(newer.find("\"version\":1"), 11, "\"version\":2");
  try_out(newer, "a newer nysalt wrote the checkpoint");
  for (const std::string& foreign :
       {std::string("some notes\n"), std::string(), std::string("{\"format\": 1}\n")}) {
    try_out(foreign, "is no checkpoint of nysalt");
  }
  std::ofstream(file, std::ios::binary) << sound;
  refused(folder, command + "--resume --seed 2", "of another run (seed)");
  const auto with = [&](const std::string& option, const std::string& other) {
    std::string changed = command;
    return changed.replace(changed.find(option), option.size(), other) + "--resume";
  };
  refused(folder, with("--horizon 400", "--horizon 401"), "of another run (steps)");
  refused(folder, with("--sigma 0.05", "--sigma 0.06"), "of another run (system)");
  refused(folder, with("--method baoab", "--method obabo"), "of another run (letters)");

  const std::string written = contents(part);
  std::ofstream(part) << written.substr(0, written.size() / 2);
  refused(folder, command + "--resume", "edited or cut");
  std::string edited = written;
  edited[edited.find("\n0,") + 20] ^= 1;
  std::ofstream(part) << edited;
  refused(folder, command + "--resume", "edited or cut");
  std::filesystem::remove(part);
  refused(folder, command + "--resume", "cannot resume from cut.csv.part: there is no such file");
  // What was written after the checkpoint does not count.
  std::ofstream(part) << written << "half a row,1";
  BOOST_TEST(run(folder, with_checkpoint(in_bath, "cut", 10000) + "--resume").code == 0);
  BOOST_TEST((contents(folder / "cut.csv") == whole(folder, in_bath)));
}

BOOST_AUTO_TEST_CASE(a_picture_is_that_of_a_run_without_a_checkpoint) {
  const scratch folder("restart_plot");
  const std::string line = in_bath + "--plot ";
  BOOST_TEST_REQUIRE(run(folder, line + "--output a.csv").code == 0);
  const std::string data = contents(folder / "a.dat");
  BOOST_TEST(data.size() > 1000U);
  BOOST_TEST(killed_at(folder, with_checkpoint(line, "a"), "a.checkpoint", 500));
  BOOST_TEST_REQUIRE(run(folder, with_checkpoint(line, "a", 10000) + "--resume").code == 0);
  BOOST_TEST((contents(folder / "a.dat") == data));
}
