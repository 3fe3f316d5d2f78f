// SPDX-License-Identifier: BSL-1.0
// A comparison that was stopped goes on where it stopped, to the same bytes but for times.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "../support/program.hpp"
#include "../support/signed_again.hpp"
#include "../support/without_times.hpp"

using namespace nysalt::test;

namespace {

// A learned family, two metrics along paths, and laws: parts of every kind.
const std::string line =
    "compare --system oscillator --omega 1 --friction 0.5 --temperature 0.1 --methods "
    "verlet,learned:nystrom,baoab "
    "--steps 0.2,0.3,0.4 --horizon 60 --trajectories 64 --learn-trajectories 16 --learn-horizon 2 --metric "
    "path,state,acf,distribution --output ";

std::string rows(const scratch& folder, const std::string& name) {
  return without_times_in_csv(contents(folder / (name + "/rows.csv")));
}

/// The journal of a run of the line above that was killed without warning when that many of its lines were
/// there.
std::string killed_after(const scratch& folder, const std::string& name, int lines) {
  const std::string journal = name + "/journal.jsonl";
  const auto done =
      shell(folder, "\"$nysalt\" " + line + name + " >/dev/null 2>&1 & pid=$!\n" +
                        "while kill -0 $pid 2>/dev/null && [ \"$(cat " + journal +
                        " 2>/dev/null | wc -l)\" -lt " + std::to_string(lines) +
                        " ]; do sleep 0.01; done\nkill -9 $pid\nwait $pid\n[ -f " + journal + " ]");
  BOOST_TEST_REQUIRE(done.code == 0, "there is no journal of " << name << ": " << done.err);
  return folder / journal;
}

std::string document(const finished& done) { return without_times(done.out); }

}  // namespace

BOOST_AUTO_TEST_CASE(a_killed_run_goes_on_to_the_same_bytes) {
  const scratch folder("resume");
  const auto whole = run(folder, line + "whole --json");
  BOOST_TEST_REQUIRE(whole.code == 0, whole.err);
  BOOST_TEST(!std::filesystem::exists(folder / "whole/journal.jsonl"));
  for (const int lines : {3, 9}) {
    const std::string name = "killed_" + std::to_string(lines);
    killed_after(folder, name, lines);
    const auto again = run(folder, line + name + " --resume --json");
    BOOST_TEST_REQUIRE(again.code == 0, again.err);
    BOOST_TEST(rows(folder, name) == rows(folder, "whole"));
    BOOST_TEST(document(again) == document(whole));
    BOOST_TEST(!std::filesystem::exists(folder / (name + "/journal.jsonl")));
  }
}

// What was finished is taken from the journal: what stands there is what comes out.
BOOST_AUTO_TEST_CASE(finished_parts_are_not_done_again) {
  const scratch folder("resume_edited");
  const std::string journal = killed_after(folder, "run", 8);
  std::string text = contents(journal);
  const std::string before = "\"findings\":[{\"value\":[";
  const auto at = text.find(before);
  BOOST_TEST_REQUIRE(at != std::string::npos);
  text.insert(at + before.size(), "12345.5,0.25],\"was\":[");
  const auto begin = text.rfind('\n', at) + 1;
  const auto end = text.find('\n', at);
  text.replace(begin, end - begin, signed_line(text.substr(begin, end - begin)));
  std::ofstream(journal) << text;
  const auto again = run(folder, line + "run --resume");
  BOOST_TEST_REQUIRE(again.code == 0, again.err);
  BOOST_TEST(rows(folder, "run").find(",12345.5,0.25,") != std::string::npos);
}

// Any digit, of the question or of a part, whatever the part does with it. The last digits of a number may
// leave the same double.
BOOST_AUTO_TEST_CASE(a_journal_of_which_a_digit_was_changed_is_refused) {
  const scratch folder("resume_digits");
  BOOST_TEST_REQUIRE(run(folder, line + "whole").code == 0);
  const std::string journal = killed_after(folder, "run", 8);
  const std::string text = contents(journal);
  std::vector<std::size_t> digits;
  for (std::size_t at = 0; at < text.rfind('\n'); ++at) {
    if (text[at] >= '0' && text[at] <= '9') digits.push_back(at);
  }
  constexpr std::size_t tries = 30;
  std::size_t refused = 0;
  for (std::size_t k = 0; k < tries; ++k) {
    const std::size_t at = digits.at(k * digits.size() / tries);
    std::string edited = text;
    edited[at] = edited[at] == '9' ? '1' : static_cast<char>(edited[at] + 1);
    std::filesystem::remove_all(folder / "run");
    std::filesystem::create_directory(folder / "run");
    std::ofstream(journal) << edited;
    const auto done = run(folder, line + "run --resume");
    const std::string shown = text.substr(std::max<std::size_t>(at, 40) - 40, 80);
    if (done.code == 0) {
      BOOST_TEST(rows(folder, "run") == rows(folder, "whole"), shown);
      continue;
    }
    BOOST_TEST(done.code == 2, shown << ": " << done.err);
    BOOST_TEST(done.err.find("cannot resume from run/journal.jsonl: ") != std::string::npos, done.err);
    BOOST_TEST(contents(journal) == edited);
    ++refused;
  }
  BOOST_TEST(refused > tries * 2 / 3);  // of 17 digits at most 3 leave the same double
}

BOOST_AUTO_TEST_CASE(a_last_line_that_was_cut_off_does_not_count) {
  const scratch folder("resume_cut");
  BOOST_TEST_REQUIRE(run(folder, line + "whole").code == 0);
  const std::string journal = killed_after(folder, "run", 6);
  const std::string text = contents(journal);
  std::ofstream(journal) << text.substr(0, text.size() - 25);
  BOOST_TEST_REQUIRE(run(folder, line + "run --resume").code == 0);
  BOOST_TEST(rows(folder, "run") == rows(folder, "whole"));
}

BOOST_AUTO_TEST_CASE(a_finished_run_is_left_alone) {
  const scratch folder("resume_finished");
  BOOST_TEST_REQUIRE(run(folder, line + "run").code == 0);
  const std::string report = contents(folder / "run/report.json");
  const auto again = run(folder, line + "run --resume");
  BOOST_TEST(again.code == 0, again.err);
  BOOST_TEST(again.out.find("finished") != std::string::npos);
  BOOST_TEST(contents(folder / "run/report.json") == report);
  // Another question is refused with --resume, and answered in its place without.
  const auto other = run(folder, line + "run --resume --seed 7");
  BOOST_TEST(other.code == 2);
  BOOST_TEST(other.err.find("run/report.json: the file is of another question (seed)") != std::string::npos,
             other.err);
  BOOST_TEST(contents(folder / "run/report.json") == report);
  BOOST_TEST(run(folder, line + "run --seed 7").code == 0);
  BOOST_TEST(contents(folder / "run/report.json") != report);
}

// A report shows the name, and would not be UTF-8 with it, or have a line more.
BOOST_AUTO_TEST_CASE(a_method_file_may_have_any_name_in_letters) {
  const scratch folder("resume_name");
  const auto compared = [&](const std::string& name, const std::string& more) {
    std::ofstream(folder / name)
        << R"({"format": "nysalt table", "version": 1, "name": "mine", "letters": "ABA", "coefficients": [0.5, 1, 0.5]})";
    return run(folder, "compare --methods '" + name +
                           "' --steps 0.01 --trajectories 2 --horizon 0.1 --output r" + more);
  };
  BOOST_TEST(compared("m\xd0\xb6 <b>.json", "").code == 0);
  const auto again = compared("m\xd0\xb6 <b>.json", " --resume");
  BOOST_TEST(again.code == 0, again.err);
  BOOST_TEST(again.out == "It is finished: r\n");
  for (const char* name : {"m\xff.json", "m\xed\xa0\x80.json", "m\xd0.json", "m\n.json", "m\x1b[31m.json",
                           "m\xc2\x9b.json", "m\x7f.json"}) {
    const auto refused = compared(name, "");
    BOOST_TEST(refused.code == 2);
    BOOST_TEST(refused.err.find("the name of a method must be UTF-8") != std::string::npos, refused.err);
  }
}

BOOST_AUTO_TEST_CASE(what_cannot_be_leaves_nothing) {
  const scratch folder("resume_nothing");
  const auto done =
      run(folder,
          "compare --system oscillator --omega 1 --friction 0.5 --temperature 0.1 --methods baoab "
          "--steps 0.2 --horizon 60 --trajectories 64 --metric distribution --range 100,101 --output "
          "new/run");
  BOOST_TEST(done.code == 2, done.err);
  BOOST_TEST(done.err.find("--range must hold values of energy of the reference") != std::string::npos,
             done.err);
  BOOST_TEST(folder.files().empty());
}

BOOST_AUTO_TEST_CASE(journals_of_others_are_refused) {
  const scratch folder("resume_refused");
  const std::string journal = killed_after(folder, "run", 9);
  const std::string text = contents(journal);
  const auto refused = [&](const std::string& arguments, const std::string& why) {
    const auto done = run(folder, arguments);
    BOOST_TEST(done.code == 2, arguments << " ended with " << done.code);
    BOOST_TEST(done.err.find(why) != std::string::npos, arguments << " said " << done.err);
    BOOST_TEST(std::count(done.err.begin(), done.err.end(), '\n') == 1);
  };
  refused(line + "run", "take --resume");
  refused(line + "run --resume --seed 2", "another question (seed)");
  refused(line + "run --resume --bins 50", "another question (bins)");
  refused("compare --methods verlet --steps 0.02 --resume", "--resume must come with --output");
  BOOST_TEST(contents(journal) == text);  // and nothing was lost
  refused(line + "run --resume --levels 0.5", "another question (levels)");
  // What is no journal is left as it is, whatever is asked; so is one that was edited.
  const auto head = text.substr(0, text.find('\n') + 1);
  for (const std::string& other :
       {std::string("{\"some\": \"file\"}\n"), std::string("some notes"),
        head + signed_line(R"({"part":7,"result":{}})") + "\n",
        head + R"({"part":"paths at 0.2","result":{}})" + "\n", head + "some notes\n"}) {
    std::ofstream(journal) << other;
    for (const char* resume : {"", " --resume"}) refused(line + "run" + resume, "is no journal");
    BOOST_TEST(contents(journal) == other);
  }
  for (const std::string& result : {std::string("5"), std::string("{\"behind\":{},\"findings\":[]}")}) {
    const auto paths = text.find("\"part\":\"paths at 0.2\"");
    const std::string edited =
        head + signed_line("{\"part\":\"paths at 0.2\",\"result\":" + result + "}") + "\n";
    BOOST_TEST(paths != std::string::npos);
    std::ofstream(journal) << edited;
    refused(line + "run --resume", "not whole, or was edited");
    BOOST_TEST(contents(journal).starts_with(edited));
  }
}

BOOST_AUTO_TEST_CASE(a_finished_run_without_a_result_says_so_again) {
  const scratch folder("resume_no_result");
  const std::string lost = "compare --methods verlet --steps 0.05 --horizon 1 --trajectories 2 --output run";
  BOOST_TEST(run(folder, lost).code == 3);
  BOOST_TEST(run(folder, lost + " --resume").code == 3);
}
