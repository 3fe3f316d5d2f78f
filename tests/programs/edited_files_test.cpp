// SPDX-License-Identifier: BSL-1.0
// Journals and checkpoints, after somebody has edited them. Each edit is one line and exit code 2, or changes
// nothing that matters.
#include <boost/test/unit_test.hpp>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "../support/forged.hpp"
#include "../support/program.hpp"

using namespace nysalt::test;
using json = nlohmann::ordered_json;

namespace {

/// Lines of a shell that wait, while process $pid lives, until a checkpoint tells of `step`, or of finished
/// trajectories.
std::string wait_for(const std::string& checkpoint, int step) {
  std::string lines = "while kill -0 $pid 2>/dev/null; do n=\"$(head -n 1 " + checkpoint;
  lines += R"x( 2>/dev/null | sed -n 's/.*"first":[0-9]*,"step":\([0-9]*\).*/\1/p')"; [ "${n:-0}" -ge )x";
  lines += std::to_string(step) + " ] && break; sleep .01; done\n";
  return lines;
}

/// Kills `nysalt line` without warning once its checkpoint tells of `step`; whether it was still running
/// then.
bool killed_at(const scratch& folder, const std::string& line, const std::string& checkpoint,
                      int step) {
  std::string lines = "\"$nysalt\" " + line + " >/dev/null 2>&1 & pid=$!\n";
  lines += wait_for(checkpoint, step);
  return shell(folder, lines + "kill -9 $pid && ! wait $pid").code == 0;
}

namespace fs = std::filesystem;

void write(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// Places of all members and elements; of a list only the first and the last.
void add_places(const json& document, const json::json_pointer& at, std::vector<json::json_pointer>& to) {
  if (document.is_object()) {
    for (const auto& [name, value] : document.items()) {
      to.push_back(at / name);
      add_places(value, at / name, to);
    }
  }
  if (!document.is_array()) return;
  for (const std::size_t k : {std::size_t{0}, document.size() - 1}) {
    if (document.empty() || (k > 0 && k + 1 < document.size())) continue;
    if (k == 0 && !to.empty() && to.back() == at / k) continue;
    to.push_back(at / k);
    add_places(document[k], at / k, to);
    if (document.size() == 1) break;
  }
}

struct edit {
  std::string what;
  std::string text;
};

/// A line of JSON with one edit of each member and element: of seven kinds, which take turns beginning with
/// `turn`.
std::vector<edit> edits_of(const std::string& line, std::size_t& turn) {
  const json sound = json::parse(line);
  std::vector<json::json_pointer> places;
  add_places(sound, json::json_pointer(), places);
  const std::vector<json> values{nullptr, json::array(), json::array({1.0}), "text", -7};
  std::vector<edit> all;
  for (const auto& at : places) {
    json other = sound;
    std::string what = at.to_string() + " ";
    const std::size_t kind = turn++ % 7;
    if (kind < values.size()) {
      other[at] = values[kind];
      what += values[kind].dump();
    } else if (kind == 5 && sound[at].is_array() && !sound[at].empty()) {
      other[at].erase(other[at].size() - 1);
      what += "shorter";
    } else if (json& parent = other[at.parent_pointer()]; parent.is_object()) {
      parent.erase(at.back());
      what += "missing";
    } else {
      parent.erase(static_cast<std::size_t>(std::stoul(at.back())));
      what += "missing";
    }
    if (other != sound) all.push_back({what, other.dump()});
  }
  return all;
}

void require_refused(const finished& done, const std::string& words, const std::string& what) {
  BOOST_TEST(done.code == 2, what << " ended with " << done.code << ": " << done.err);
  BOOST_TEST(is_one_line(done.err), what << ": " << done.err);
  BOOST_TEST(done.err.starts_with("nysalt: "), what << ": " << done.err);
  BOOST_TEST(done.err.find(words) != std::string::npos, what << ": " << done.err);
  BOOST_TEST(done.err.find("json.exception") == std::string::npos, what << ": " << done.err);
}

/// A comparison into the folder `out`, whose journal is whole while the pictures of its report are drawn: a
/// gnuplot that draws nothing keeps a copy then.
struct comparison {
  scratch folder;
  std::string line;
  comparison(const std::string& name, std::string arguments)
      : folder(name), line("\"$nysalt\" " + std::move(arguments) + " --output out") {
    write(folder / "gnuplot", "#!/bin/sh\ncp ../journal.jsonl ../../kept\nexit 1\n");
    BOOST_TEST_REQUIRE(shell(folder, "chmod +x gnuplot").code == 0);
    BOOST_TEST_REQUIRE(shell(folder, "PATH=$PWD:$PATH " + line).code == 0);
  }

  std::string kept() const { return contents(folder / "kept"); }

  /// Goes on from a journal, and keeps the journal at its end if that is asked for.
  finished resumed(const std::string& journal, bool keeps = false) const {
    fs::remove_all(folder / "out");
    fs::create_directory(folder / "out");
    write(folder / "out/journal.jsonl", journal);
    return shell(folder, (keeps ? "PATH=$PWD:$PATH " : "PATH=/nowhere ") + line + " --resume");
  }
};

/// Edits each part of the journal of a comparison, of its places one in `every`, and resumes it.
void edit_journal_of(const std::string& name, const std::string& arguments, std::size_t every) {
  const comparison whole(name, arguments);
  const auto lines = lines_of(whole.kept());
  BOOST_TEST_REQUIRE(lines.size() > 2U);
  BOOST_TEST_REQUIRE(whole.resumed(whole.kept()).code == 0);
  std::size_t refused = 0;
  std::size_t turn = 0;
  std::size_t number = 0;
  for (std::size_t k = 1; k < lines.size(); ++k) {
    for (const auto& [what, text] : edits_of(lines[k], turn)) {
      const bool is_of_checksum = what.starts_with("/checksum");
      if (number++ % every != 0) continue;
      const std::string line_again = is_of_checksum ? text : signed_line(text);
      std::string edited;
      for (std::size_t i = 0; i < lines.size(); ++i) edited += (i == k ? line_again : lines[i]) + "\n";
      const std::string shown = lines[k].substr(0, 60) + ": " + what;
      const auto done = whole.resumed(edited);
      if (done.code == 2 || is_of_checksum) {
        require_refused(done, "cannot resume from out/journal.jsonl: ", shown);
        ++refused;
        continue;
      }
      BOOST_TEST((done.code == 0 || done.code == 3),
                 shown << " ended with " << done.code << ": " << done.err);
      BOOST_TEST(json::accept(contents(whole.folder / "out/report.json")), shown);
      BOOST_TEST(fs::exists(whole.folder / "out/report.html"), shown);
      BOOST_TEST(!fs::exists(whole.folder / "out/journal.jsonl"), shown);
    }
  }
  BOOST_TEST(refused > 10U);
}

/// Edits the head of a checkpoint, and goes on from it.
template <class Restore>
void edit_checkpoint(const scratch& folder, const std::string& line, const Restore& restore) {
  const std::string sound = contents(folder / "c");
  const auto end = sound.find('\n');
  std::size_t turn = 0;
  std::size_t refused = 0;
  for (const auto& [what, head] : edits_of(sound.substr(0, end), turn)) {
    restore();
    write(folder / "c", signed_again(head + sound.substr(end)));
    const auto done = run(folder, line + "--resume");
    if (done.code != 0) require_refused(done, "", what);
    refused += done.code != 0 ? 1U : 0U;
  }
  BOOST_TEST(refused > 5U);
}

}  // namespace

BOOST_AUTO_TEST_CASE(an_edited_journal_of_paths_is_refused_or_taken_whole) {
  edit_journal_of("edited_paths",
                  "compare --system pendulum --methods learned:bab2 --steps 0.2 --horizon 4 "
                  "--trajectories 4 --learn-trajectories 4 --learn-horizon 1 --learn-effort quick --metric "
                  "path,acceptance",
                  3);
}

BOOST_AUTO_TEST_CASE(an_edited_journal_of_distributions_is_refused_or_taken_whole) {
  edit_journal_of("edited_distributions",
                  "compare --system oscillator --omega 1 --friction 0.5 --temperature 0.1 --methods baoab "
                  "--steps 0.2 --horizon 20 --trajectories 4 --bins 5 --metric acf,distribution",
                  3);
}

// Stopped, cut in the midst of a line, resumed; stopped again, cut again and resumed again: the same rows.
// A line that was cut off and stays in the file is refused.
BOOST_AUTO_TEST_CASE(a_line_that_was_cut_off_is_gone_when_it_is_resumed_again) {
  const comparison whole(
      "cut_twice",
      "compare --system pendulum --methods verlet,mclachlan2 --steps 0.1,0.2,0.3 --horizon 4 "
      "--trajectories 4 --metric path,energy");
  const auto rows = [&] { return without_times_in_csv(contents(whole.folder / "out/rows.csv")); };
  const std::string expected = rows();
  const auto lines = lines_of(whole.kept());
  BOOST_TEST_REQUIRE(lines.size() > 3U);
  const std::string two = lines[0] + "\n" + lines[1] + "\n";
  const std::string half = lines[2].substr(0, lines[2].size() / 2);
  BOOST_TEST_REQUIRE(whole.resumed(two + half, true).code == 0);
  BOOST_TEST(rows() == expected);
  const std::string again = whole.kept();
  BOOST_TEST(lines_of(again).size() == lines.size());
  for (const std::size_t cut : {25U, 0U}) {
    const auto done = whole.resumed(again.substr(0, again.size() - cut));
    BOOST_TEST(done.code == 0, done.err);
    BOOST_TEST(rows() == expected);
  }
  require_refused(whole.resumed(two + half + lines[2] + "\n" + lines[3] + "\n"),
                  "cannot resume from out/journal.jsonl: ", "a line that was cut off");
}

BOOST_AUTO_TEST_CASE(an_edited_checkpoint_of_a_run_is_refused_or_gone_on_with) {
  const scratch folder("edited_run");
  const std::string line =
      "run --system pendulum --friction 0.1 --temperature 0.5 --method baoab --step 0.01 --horizon 4000 "
      "--trajectories 5 --sample-every 10000 --every 6400 --output out.csv --checkpoint c ";
  BOOST_TEST_REQUIRE(killed_at(folder, line, "c", 200'000));
  const std::string part = contents(folder / "out.csv.part");
  edit_checkpoint(folder, line, [&] {
    write(folder / "out.csv.part", part);
    fs::remove(folder / "out.csv");
  });
}

BOOST_AUTO_TEST_CASE(an_edited_checkpoint_of_chains_is_refused_or_gone_on_with) {
  const scratch folder("edited_chains");
  const std::string line =
      "sample --system linear_chain --masses 3 --spring 4 --length 1 --burn-in 100 --draws 20000 --chains 2 "
      "--output out.csv --checkpoint c --every 100 ";
  const auto killed =
      shell(folder, "\"$nysalt\" " + line + " >/dev/null 2>&1 & pid=$!\n" +
                        "while [ ! -f c ]; do sleep .01; done; kill -9 $pid; wait $pid; [ -f c ]");
  BOOST_TEST_REQUIRE(killed.code == 0, killed.err);
  edit_checkpoint(folder, line, [] {});
}
