// SPDX-License-Identifier: BSL-1.0
// What a run goes on with: checkpoints, outputs under way and journals that are not whole, foreign or of
// another run are refused and left alone, and finished parts are not computed again. Edits of each member of
// them: edited_files_test; that what was stopped comes to the same bytes: stopping_test.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "../support/forged.hpp"
#include "../support/stopping.hpp"
#include "../support/table.hpp"

using namespace nysalt::test;

namespace {

const std::string in_bath =
    "run --system fpu --friction 0.01 --sigma 0.05 --start law --method baoab --step 0.01 --horizon 4 "
    "--trajectories 37 --sample-every 20 --observables stiff_energy,q1,p6 ";
const std::string compare =
    "compare --system oscillator --omega 1 --friction 0.5 --temperature 0.1 --methods verlet,baoab --steps "
    "0.3 "
    "--horizon 10 --trajectories 32 --metric path,state,acf --output ";

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

void refused(const scratch& folder, const std::string& arguments, const std::string& why) {
  const auto before = folder.files();
  const auto done = run(folder, arguments);
  BOOST_TEST(done.code == 2, arguments << " ended with " << done.code);
  BOOST_TEST(done.err.find(why) != std::string::npos, arguments << " said " << done.err);
  BOOST_TEST(std::ranges::count(done.err, '\n') == 1, done.err);
  BOOST_TEST((folder.files() == before), arguments << " left something");
}

bool has_hdf5() { return run(in_bath + "--output a.h5").err.find("built without HDF5") == std::string::npos; }
std::vector<std::string> kinds() {
  std::vector<std::string> all{".csv", ".npy"};
  if (has_hdf5()) all.emplace_back(".h5");
  return all;
}

/// The journal of a comparison that was killed before its last but two line was there.
std::string journal_of_killed(const scratch& folder, const std::string& name) {
  const scratch counting("checkpoints_counted");
  const int lines = calls_of(counting, compare + name)["fflush"];
  BOOST_TEST_REQUIRE(lines > 4);
  BOOST_TEST(is_killed_at(folder, "fflush:" + std::to_string(lines - 2), compare + name));
  return folder / (name + "/journal.jsonl");
}

}  // namespace

BOOST_AUTO_TEST_CASE(rows_of_checkpoints) { run_table("checkpoints"); }

// Bytes that are no UTF-8, which a checkpoint in JSON cannot hold, in names of outputs; in names of methods,
// which reports show, they are refused, and what begins a line or controls a terminal is too.
BOOST_AUTO_TEST_CASE(names_of_other_bytes) {
  for (const auto& kind : kinds()) {
    const scratch folder("checkpoints_name");
    BOOST_TEST_REQUIRE(run(folder, in_bath + "--output whole" + kind).code == 0);
    const std::string command = in_bath + "--checkpoint c --every 100 --output ";
    const std::string name = "o\xff" + kind;
    BOOST_TEST(is_killed_at(folder, "rename:3", command + name));
    refused(folder, command + "o" + kind + " --resume", "--output must be o");
    const auto done = run(folder, command + name + " --resume");
    BOOST_TEST(done.code == 0, done.err);
    BOOST_TEST((contents(folder / name) == contents(folder / ("whole" + kind))), kind);
  }
  const scratch folder("checkpoints_methods");
  for (const std::string name : {"m\xff.json", "m\xed\xa0\x80.json", "m\xd0.json", "m\n.json",
                                 "m\x1b[31m.json", "m\xc2\x9b.json", "m\x7f.json"}) {
    write(
        folder / name,
        R"({"format": "nysalt table", "version": 1, "name": "mine", "letters": "ABA", "coefficients": [0.5, 1, 0.5]})");
    refused(folder, "compare --methods '" + name + "' --steps 0.01 --trajectories 2 --horizon 0.1 --output r",
            "the name of a method must be UTF-8");
  }
}

BOOST_AUTO_TEST_CASE(checkpoints_that_are_not_whole_foreign_or_newer_are_refused_and_left_alone) {
  const scratch folder("checkpoints_refused");
  const std::string command = in_bath + "--output cut.csv --checkpoint c --every 100 ";
  BOOST_TEST_REQUIRE(is_killed_at(folder, "rename:4", command));
  const std::string sound = contents(folder / "c");
  const auto try_out = [&](const std::string& text, const std::string& why) {
    write(folder / "c", text);
    for (const char* resume : {"--resume", ""})
      refused(folder, command + resume, why);  // nor is it begun anew
    BOOST_TEST((contents(folder / "c") == text));
  };
  refused(folder, command, "take --resume to go on with the run");
  refused(folder, in_bath + "--output cut.csv --checkpoint another --every 100",
          "a run that was stopped left it");
  for (const std::size_t length : {sound.size() - 1, sound.size() / 2, sound.find('\n') + 1})
    try_out(sound.substr(0, length), "not whole, or was edited");
  for (const std::size_t at : {sound.size() / 2, sound.find("\"seed\"") + 7, sound.size() - 3}) {
    std::string edited = sound;
    edited[at] = static_cast<char>(edited[at] ^ 1);
    try_out(edited, "not whole, or was edited");
  }
  std::string newer = sound;
  newer.replace(newer.find("\"version\":1"), 11, "\"version\":2");
  try_out(newer, "a newer nysalt wrote the checkpoint");
  for (const std::string foreign : {"some notes\n", "", "{\"format\": 1}\n"})
    try_out(foreign, "is no checkpoint of nysalt");
  write(folder / "c", sound);
  refused(folder, command + "--resume --seed 2", "of another run (seed)");
  const auto with = [&](const std::string& option, const std::string& other) {
    std::string changed = command;
    return changed.replace(changed.find(option), option.size(), other) + "--resume";
  };
  refused(folder, with("--horizon 4", "--horizon 5"), "of another run (steps)");
  refused(folder, with("--sigma 0.05", "--sigma 0.06"), "of another run (system)");
  refused(folder, with("--method baoab", "--method obabo"), "of another run (letters)");
}

BOOST_AUTO_TEST_CASE(an_output_under_way_that_is_another_is_refused) {
  for (const auto& kind : kinds()) {
    const scratch folder("checkpoints_part");
    const std::string output = in_bath + "--output a" + kind;
    const std::string command = output + " --checkpoint c --every 100 --resume";
    BOOST_TEST(is_killed_at(folder, "rename:4", output + " --checkpoint c --every 100"));
    const std::filesystem::path part = folder / ("a" + kind + ".part");
    const std::string sound = contents(part);
    std::string edited = sound;
    edited[kind == ".csv" ? sound.find("\n0,") + 20 : 20] ^= 1;
    for (const std::string& text : {sound.substr(0, sound.size() / 2), edited, std::string()}) {
      write(part, text);
      refused(folder, command, "edited or cut");
    }
    write(part, sound);
    const auto whole = run(folder, output);  // a run without a checkpoint leaves it alone
    BOOST_TEST_REQUIRE(whole.code == 0, whole.err);
    BOOST_TEST((contents(part) == sound));
    std::filesystem::remove(part);
    refused(folder, command, "cannot resume from a" + kind + ".part: there is no such file");
    if (kind != ".csv") continue;
    // Of a table, what was written after the checkpoint does not count.
    write(part, sound + "half a row,1");
    const std::string expected = contents(folder / "a.csv");
    BOOST_TEST(run(folder, command).code == 0);
    BOOST_TEST((contents(folder / "a.csv") == expected));
  }
}

// What was finished is taken from the journal: what stands there is what comes out.
BOOST_AUTO_TEST_CASE(finished_parts_are_not_computed_again) {
  const scratch folder("checkpoints_journal");
  const std::string journal = journal_of_killed(folder, "run");
  std::string text = contents(journal);
  const std::string before = "\"findings\":[{\"value\":[";
  const auto at = text.find(before);
  BOOST_TEST_REQUIRE(at != std::string::npos);
  text.insert(at + before.size(), "12345.5,0.25],\"was\":[");
  const auto begin = text.rfind('\n', at) + 1;
  const auto end = text.find('\n', at);
  text.replace(begin, end - begin, signed_line(text.substr(begin, end - begin)));
  write(journal, text);
  const auto again = quietly(folder, compare + "run --resume");
  BOOST_TEST_REQUIRE(again.code == 0, again.err);
  BOOST_TEST(contents(folder / "run/rows.csv").find(",12345.5,0.25,") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(journals_of_others_are_refused) {
  const scratch folder("checkpoints_journals");
  const std::string journal = journal_of_killed(folder, "run");
  const std::string text = contents(journal);
  refused(folder, compare + "run", "take --resume");
  refused(folder, compare + "run --resume --seed 2", "another question (seed)");
  refused(folder, compare + "run --resume --levels 0.5", "another question (levels)");
  BOOST_TEST(contents(journal) == text);  // and nothing was lost
  // What is no journal is left as it is, whatever is asked; so is one that was edited.
  const auto head = text.substr(0, text.find('\n') + 1);
  for (const std::string& other :
       {std::string("{\"some\": \"file\"}\n"), std::string("some notes"),
        head + signed_line(R"({"part":7,"result":{}})") + "\n",
        head + R"({"part":"paths at 0.3","result":{}})" + "\n", head + "some notes\n"}) {
    write(journal, other);
    for (const char* resume : {"", " --resume"}) refused(folder, compare + "run" + resume, "is no journal");
    BOOST_TEST(contents(journal) == other);
  }
  BOOST_TEST(text.find("\"part\":\"paths at 0.3\"") != std::string::npos);
  for (const std::string result : {"5", "{\"behind\":{},\"findings\":[]}"}) {
    const std::string edited =
        head + signed_line("{\"part\":\"paths at 0.3\",\"result\":" + result + "}") + "\n";
    write(journal, edited);
    refused(folder, compare + "run --resume", "not whole, or was edited");
    BOOST_TEST(contents(journal).starts_with(edited));
  }
}
