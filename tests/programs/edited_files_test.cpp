// SPDX-License-Identifier: BSL-1.0
// Journals and checkpoints, after somebody has edited and signed them again. Each edit is one line and exit
// code 2, or changes nothing that matters. What is not signed again: cases/checkpoints.txt.
#include <boost/test/unit_test.hpp>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../support/forged.hpp"
#include "../support/shown_commands.hpp"
#include "../support/stopping.hpp"

using namespace nysalt::test;
using json = nlohmann::ordered_json;

namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

/// Places of all members and elements; of a list only the first and the last.
void add_places(const json& document, const json::json_pointer& at, std::vector<json::json_pointer>& to) {
  for (const auto& [name, value] : document.items()) {
    if (document.is_array() && name != "0" && name != std::to_string(document.size() - 1)) continue;
    const auto place = at / name;
    to.push_back(place);
    if (value.is_structured()) add_places(value, place, to);
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
    } else {
      json& parent = other[at.parent_pointer()];
      if (parent.is_object()) parent.erase(at.back());
      if (parent.is_array()) parent.erase(static_cast<std::size_t>(std::stoul(at.back())));
      what += "missing";
    }
    if (other != sound) all.push_back({what, other.dump()});
  }
  return all;
}

void require_refused(const finished& done, const std::string& words, const std::string& what) {
  BOOST_TEST(done.code == 2, what << " ended with " << done.code << ": " << done.err);
  BOOST_TEST(is_one_line(done.err), what << ": " << done.err);
  BOOST_TEST(done.err.starts_with("nysalt: " + words), what << ": " << done.err);
  BOOST_TEST(done.err.find("json.exception") == std::string::npos, what << ": " << done.err);
}

const std::string of_journal = "cannot resume from out/journal.jsonl: ";

/// A comparison into the folder `out`, whose journal is whole while the pictures of its report are drawn: a
/// gnuplot that draws nothing keeps a copy then.
struct comparison {
  scratch folder;
  std::string line;
  comparison(const std::string& name, std::string arguments)
      : folder(name), line("\"$nysalt\" " + std::move(arguments) + " --output out") {
    const std::string here = folder.path().string();
    write(folder / "gnuplot", "#!/bin/sh\ncp '" + here + "/out/journal.jsonl' '" + here + "/kept'\nexit 1\n");
    BOOST_TEST_REQUIRE(shell(folder, "chmod +x gnuplot && PATH=$PWD:$PATH " + line).code == 0);
  }

  std::string kept() const { return contents(folder / "kept"); }
  std::string rows() const { return without_times_in_csv(contents(folder / "out/rows.csv")); }

  /// Goes on from a journal, and keeps the journal at its end if that is asked for.
  finished resumed(const std::string& journal, bool keeps = false) const {
    fs::remove_all(folder / "out");
    fs::create_directory(folder / "out");
    write(folder / "out/journal.jsonl", journal);
    return shell(folder, (keeps ? "PATH=$PWD:$PATH " : no_pictures) + line + " --resume");
  }
};

/// Edits each part of the journal of a comparison, of its places one in three, and resumes it.
void edit_journal_of(const std::string& name, const std::string& arguments) {
  const comparison whole(name, arguments);
  const auto lines = lines_of(whole.kept());
  BOOST_TEST_REQUIRE(lines.size() > 2U);
  BOOST_TEST_REQUIRE(whole.resumed(whole.kept()).code == 0);
  std::size_t refused = 0;
  std::size_t turn = 0;
  std::size_t number = 0;
  for (std::size_t k = 1; k < lines.size(); ++k) {
    for (const auto& [what, text] : edits_of(lines[k], turn)) {
      if (number++ % 3 != 0) continue;
      const bool is_of_checksum = what.starts_with("/checksum");
      std::string edited;
      for (std::size_t i = 0; i < lines.size(); ++i)
        edited += (i != k ? lines[i] : is_of_checksum ? text : signed_line(text)) + "\n";
      const std::string shown = lines[k].substr(0, 60) + ": " + what;
      const auto done = whole.resumed(edited);
      if (done.code == 2 || is_of_checksum) {
        require_refused(done, of_journal, shown);
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

/// Edits the checkpoint c, signs it again and resumes by it, each time from the output that was there.
void edit_checkpoint_in(const scratch& folder, const std::string& resume) {
  const std::string sound = contents(folder / "c");
  std::map<std::string, std::string> outputs;
  for (const char* file : {"out.csv", "out.csv.part"}) {
    if (fs::exists(folder / file)) outputs[file] = contents(folder / file);
  }
  const auto end = sound.find('\n');
  std::size_t turn = 0;
  std::size_t refused = 0;
  for (const auto& [what, head] : edits_of(sound.substr(0, end), turn)) {
    for (const char* file : {"out.csv", "out.csv.part"}) fs::remove(folder / file);
    for (const auto& [file, text] : outputs) write(folder / file, text);
    write(folder / "c", signed_again(head + sound.substr(end)));
    const auto done = run(folder, resume);
    if (done.code != 0) require_refused(done, "", what);
    refused += done.code != 0 ? 1U : 0U;
  }
  BOOST_TEST(refused > 5U, resume);
}

}  // namespace

BOOST_AUTO_TEST_CASE(an_edited_journal_is_refused_or_taken_whole) {
  edit_journal_of("edited_paths",
                  "compare --system pendulum --methods learned:bab2 --steps 0.2 --horizon 4 --trajectories 4 "
                  "--learn-trajectories 4 --learn-horizon 1 --learn-effort quick --metric path,acceptance");
  edit_journal_of("edited_distributions",
                  "compare --system oscillator --omega 1 --friction 0.5 --temperature 0.1 --methods baoab "
                  "--steps 0.2 --horizon 20 --trajectories 4 --bins 5 --metric acf,distribution");
}

// Stopped, cut in the midst of a line, resumed; stopped again, cut again and resumed again: the same rows.
// A line that was cut off and stays in the file is refused.
BOOST_AUTO_TEST_CASE(a_line_that_was_cut_off_is_gone_when_it_is_resumed_again) {
  const comparison whole("cut_twice",
                         "compare --system pendulum --methods verlet,mclachlan2 --steps 0.1,0.2,0.3 "
                         "--horizon 4 --trajectories 4 --metric path,energy");
  const std::string expected = whole.rows();
  const auto lines = lines_of(whole.kept());
  BOOST_TEST_REQUIRE(lines.size() > 3U);
  const std::string two = lines[0] + "\n" + lines[1] + "\n";
  const std::string half = lines[2].substr(0, lines[2].size() / 2);
  BOOST_TEST_REQUIRE(whole.resumed(two + half, true).code == 0);
  BOOST_TEST(whole.rows() == expected);
  const std::string again = whole.kept();
  BOOST_TEST(lines_of(again).size() == lines.size());
  for (const std::size_t cut : {25U, 0U}) {
    const auto done = whole.resumed(again.substr(0, again.size() - cut));
    BOOST_TEST(done.code == 0, done.err);
    BOOST_TEST(whole.rows() == expected);
  }
  require_refused(whole.resumed(two + half + lines[2] + "\n" + lines[3] + "\n"), of_journal,
                  "a line that was cut off");
}

BOOST_AUTO_TEST_CASE(journals_of_others_are_refused_and_finished_parts_are_not_computed_again) {
  const comparison whole("journals",
                         "compare --system oscillator --omega 1 --friction 0.5 --temperature 0.1 --methods "
                         "verlet,baoab --steps 0.3 --horizon 10 --trajectories 32 --metric path,state,acf");
  auto lines = lines_of(whole.kept());
  BOOST_TEST_REQUIRE(lines.size() > 2U);
  const std::string head = lines[0] + "\n";
  const fs::path journal = whole.folder / "out/journal.jsonl";
  const auto refused = [&](const std::string& text, const std::string& more, const std::string& why) {
    write(journal, text);
    const auto done = shell(whole.folder, no_pictures + whole.line + more);
    require_refused(done, "", text + more);
    BOOST_TEST(done.err.find(why) != std::string::npos, done.err);
    BOOST_TEST(contents(journal) == text);  // and nothing was lost
  };
  fs::remove_all(whole.folder / "out");
  fs::create_directory(whole.folder / "out");
  const std::string begun = head + lines[1] + "\n";
  refused(begun, "", "take --resume");
  refused(begun, " --resume --seed 2", "another question (seed)");
  refused(begun, " --resume --levels 0.5", "another question (levels)");
  for (const std::string& other :
       {std::string("{\"some\": \"file\"}\n"), std::string("some notes"),
        head + signed_line(R"({"part":7,"result":{}})") + "\n",
        head + R"({"part":"paths at 0.3","result":{}})" + "\n", head + "some notes\n"}) {
    for (const char* resume : {"", " --resume"}) refused(other, resume, "is no journal");
  }
  BOOST_TEST(whole.kept().find("\"part\":\"paths at 0.3\"") != std::string::npos);
  for (const std::string result : {"5", "[{\"against\":{},\"measurements\":[]}]"}) {
    const auto edited = head + signed_line(R"({"part":"paths at 0.3","result":)" + result + "}") + "\n";
    require_refused(whole.resumed(edited), of_journal + "the part 'paths at 0.3' is not whole, or was edited",
                    result);
    BOOST_TEST(contents(journal).starts_with(edited));
  }
  // What was finished is taken from the journal: what stands there is what comes out.
  const std::string before = "\"measurements\":[{\"value\":{";
  const auto part = std::ranges::find_if(lines, [&](auto& line) { return line.find(before) < line.size(); });
  BOOST_TEST_REQUIRE((part != lines.end()));
  part->insert(part->find(before) + before.size(), "\"mean\":12345.5,\"standard_error\":0.25},\"was\":{");
  const auto again = whole.resumed(head + signed_line(*part) + "\n");
  BOOST_TEST_REQUIRE(again.code == 0, again.err);
  BOOST_TEST(contents(whole.folder / "out/rows.csv").find(",12345.5,,0.25,") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(an_edited_checkpoint_is_refused_or_gone_on_with) {
  for (const std::string arguments :
       {"run --system pendulum --friction 0.1 --temperature 0.5 --method baoab --step 0.01 --horizon 40 "
        "--trajectories 5 --sample-every 100 --every 640",
        "sample --system linear_chain --masses 3 --spring 4 --length 1 --burn-in 100 --draws 200 --chains 2 "
        "--every 50"}) {
    const scratch folder("edited_checkpoint");
    const std::string line = arguments + " --output out.csv --checkpoint c";
    BOOST_TEST_REQUIRE(is_killed_at(folder, "rename:4", line));
    edit_checkpoint_in(folder, line + " --resume");
  }
}

BOOST_AUTO_TEST_CASE(an_edited_checkpoint_of_a_finished_run_is_refused_or_the_run_is_prolonged) {
  const scratch folder("edited_finished");
  const std::string line =
      "run --system henon_heiles --spread 2.5 --method verlet --step 0.3 --trajectories 5 --sample-every 7 "
      "--every 640 --output out.csv --checkpoint c --horizon ";
  BOOST_TEST_REQUIRE(run(folder, line + "30").code == 0);
  edit_checkpoint_in(folder, line + "60 --resume");
}

// Format 1 has the numbers of the batch under way alone.
BOOST_AUTO_TEST_CASE(a_checkpoint_of_format_1_is_gone_on_with_and_its_run_is_not_prolonged) {
  const scratch folder("format_1");
  const std::string line =
      "run --system pendulum --method verlet --step 0.01 --trajectories 5 --sample-every 100 --every 640 "
      "--output out.csv --checkpoint c --horizon ";
  const auto put_format_1 = [&](bool with_numbers) {
    const std::string text = contents(folder / "c");
    json head = json::parse(text.substr(0, text.find('\n')));
    head["version"] = 1;
    for (const char* newer : {"began", "keeps_all", "is_copied"}) BOOST_TEST(head.erase(newer) == 1U);
    const auto last_line = text.rfind("\ncrc32 ");
    const std::string numbers =
        with_numbers ? text.substr(text.find('\n'), last_line - text.find('\n')) : "\n";
    write(folder / "c", signed_again(head.dump() + numbers + text.substr(last_line)));
  };
  BOOST_TEST_REQUIRE(run(folder, line + "40").code == 0);
  const std::string whole = contents(folder / "out.csv");
  put_format_1(false);
  BOOST_TEST(run(folder, line + "40 --resume").code == 0);
  require_refused(run(folder, line + "50 --resume"),
                  "cannot prolong the run of c: the checkpoint does not keep", "");
  fs::remove(folder / "c");
  BOOST_TEST_REQUIRE(is_killed_at(folder, "rename:4", line + "40"));
  put_format_1(true);
  BOOST_TEST(run(folder, line + "40 --resume").code == 0);
  BOOST_TEST(contents(folder / "out.csv") == whole);
}
