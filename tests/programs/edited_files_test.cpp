// SPDX-License-Identifier: BSL-1.0
// Work files, after somebody has edited and signed them again. Each edit is one line and exit code 2, or
// changes nothing that matters. What is not signed again: cases/work_files.txt.
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

const std::string of_work = "cannot resume from out/report.work: ";

/// A comparison into the folder `out`, whose work file is whole: a gnuplot that draws nothing puts a folder
/// in the place of the page, which cannot be written then.
struct comparison {
  scratch folder;
  std::string line;
  comparison(const std::string& name, std::string arguments)
      : folder(name), line("\"$nysalt\" " + std::move(arguments) + " --output out") {
    const std::string here = folder.path().string();
    write(folder / "gnuplot", "#!/bin/sh\nmkdir -p '" + here + "/out/report.html.new.part'\nexit 1\n");
    BOOST_TEST_REQUIRE(shell(folder, "chmod +x gnuplot && PATH=$PWD:$PATH " + line).code != 0);
    kept_ = contents(folder / "out/report.work");
  }

  const std::string& kept() const { return kept_; }

  /// Goes on from a work file.
  finished resumed(const std::string& work) const {
    fs::remove_all(folder / "out");
    fs::create_directory(folder / "out");
    write(folder / "out/report.work", work);
    return shell(folder, no_pictures + line + " --resume");
  }

 private:
  std::string kept_;
};

/// Edits each part of the work file of a comparison, of its places one in three, and resumes it.
void edit_comparison(const std::string& name, const std::string& arguments) {
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
        require_refused(done, of_work, shown);
        ++refused;
        continue;
      }
      BOOST_TEST((done.code == 0 || done.code == 3),
                 shown << " ended with " << done.code << ": " << done.err);
      BOOST_TEST(json::accept(contents(whole.folder / "out/report.json")), shown);
      BOOST_TEST(fs::exists(whole.folder / "out/report.html"), shown);
      BOOST_TEST(!fs::exists(whole.folder / "out/report.work"), shown);
    }
  }
  BOOST_TEST(refused > 10U);
}

/// Edits the state in a work file, signs it again and resumes by it, each time from the output that was
/// there.
void edit_state_in(const scratch& folder, const std::string& resume) {
  const std::string sound = contents(folder / "out.csv.work");
  std::map<std::string, std::string> outputs;
  for (const char* file : {"out.csv", "out.csv.part"}) {
    if (fs::exists(folder / file)) outputs[file] = contents(folder / file);
  }
  const auto begin = sound.find(R"({"part":"state")");
  const auto end = sound.find('\n', begin);
  std::size_t turn = 0;
  std::size_t refused = 0;
  for (const auto& [what, state] : edits_of(sound.substr(begin, end - begin), turn)) {
    for (const char* file : {"out.csv", "out.csv.part"}) fs::remove(folder / file);
    for (const auto& [file, text] : outputs) write(folder / file, text);
    write(folder / "out.csv.work", sound.substr(0, begin) + signed_line(state) + sound.substr(end));
    const auto done = run(folder, resume);
    if (done.code != 0) require_refused(done, "", what);
    refused += done.code != 0 ? 1U : 0U;
  }
  // Each of the two numbers of the state of chains, changed or missing.
  BOOST_TEST(refused >= 4U, refused << " of " << resume << " " << sound.substr(begin, end - begin));
}

}  // namespace

BOOST_AUTO_TEST_CASE(an_edited_comparison_is_refused_or_taken_whole) {
  edit_comparison("edited_paths",
                  "compare --system pendulum --methods learned:bab2 --steps 0.2 --horizon 4 --trajectories 4 "
                  "--learn-trajectories 4 --learn-horizon 1 --learn-effort quick --metric path,acceptance");
  edit_comparison("edited_distributions",
                  "compare --system oscillator --omega 1 --friction 0.5 --temperature 0.1 --methods baoab "
                  "--steps 0.2 --horizon 20 --trajectories 4 --bins 5 --metric acf,distribution");
}

BOOST_AUTO_TEST_CASE(work_files_of_others_are_refused_and_finished_parts_are_not_computed_again) {
  const comparison whole("work_files",
                         "compare --system oscillator --omega 1 --friction 0.5 --temperature 0.1 --methods "
                         "verlet,baoab --steps 0.3 --horizon 10 --trajectories 32 --metric path,state,acf");
  auto lines = lines_of(whole.kept());
  BOOST_TEST_REQUIRE(lines.size() > 2U);
  const std::string head = lines[0] + "\n";
  const fs::path work = whole.folder / "out/report.work";
  const auto refused = [&](const std::string& text, const std::string& more, const std::string& why) {
    write(work, text);
    const auto done = shell(whole.folder, no_pictures + whole.line + more);
    require_refused(done, "", text + more);
    BOOST_TEST(done.err.find(why) != std::string::npos, done.err);
    BOOST_TEST(contents(work) == text);  // and nothing was lost
  };
  fs::remove_all(whole.folder / "out");
  fs::create_directory(whole.folder / "out");
  const std::string begun = head + lines[1] + "\n";
  refused(begun, "", "resume it");
  refused(begun, " --resume --seed 2", "another question (seed)");
  refused(begun, " --resume --levels 0.5", "another question (levels)");
  for (const std::string& other :
       {std::string("{\"some\": \"file\"}\n"), std::string("some notes"),
        head + signed_line(R"({"part":7,"result":{}})") + "\n",
        head + R"({"part":"paths at 0.3","result":{}})" + "\n", head + "some notes\n"}) {
    for (const char* resume : {"", " --resume"}) refused(other, resume, "is no work file");
  }
  BOOST_TEST(whole.kept().find("\"part\":\"paths at 0.3\"") != std::string::npos);
  for (const std::string result : {"5", "[{\"against\":{},\"measurements\":[]}]"}) {
    const auto edited = head + signed_line(R"({"part":"paths at 0.3","result":)" + result + "}") + "\n";
    require_refused(whole.resumed(edited), of_work + "the part 'paths at 0.3' is not whole, or was edited",
                    result);
    BOOST_TEST(contents(work) == edited);
  }
  // What was finished is taken from the work file: what stands there is what comes out.
  const std::string before = "\"measurements\":[{\"value\":{";
  const auto part = std::ranges::find_if(lines, [&](auto& line) { return line.find(before) < line.size(); });
  BOOST_TEST_REQUIRE((part != lines.end()));
  part->insert(part->find(before) + before.size(), "\"mean\":12345.5,\"standard_error\":0.25},\"was\":{");
  const auto again = whole.resumed(head + signed_line(*part) + "\n");
  BOOST_TEST_REQUIRE(again.code == 0, again.err);
  BOOST_TEST(contents(whole.folder / "out/rows.csv").find(",12345.5,,0.25,") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(an_edited_state_is_refused_or_gone_on_with) {
  for (const std::string arguments :
       {"run --system pendulum --friction 0.1 --temperature 0.5 --method baoab --step 0.01 --horizon 40 "
        "--trajectories 5 --sample-every 100 --every 640",
        "sample --system linear_chain --masses 3 --spring 4 --length 1 --burn-in 100 --draws 200 --chains 2 "
        "--every 50"}) {
    const scratch folder("edited_state");
    const std::string line = arguments + " --output out.csv";
    BOOST_TEST_REQUIRE(is_killed_at(folder, "rename:4", line));
    edit_state_in(folder, line + " --resume");
  }
}

BOOST_AUTO_TEST_CASE(an_edited_state_of_a_finished_run_is_refused_or_the_run_is_prolonged) {
  const scratch folder("edited_finished");
  const std::string line =
      "run --system henon_heiles --spread 2.5 --method verlet --step 0.3 --trajectories 5 --sample-every 7 "
      "--keep-work --output out.csv --horizon ";
  BOOST_TEST_REQUIRE(run(folder, line + "30").code == 0);
  edit_state_in(folder, line + "60 --resume");
}
