// SPDX-License-Identifier: BSL-1.0
// Files that the program has written and reads again, after somebody has edited them: journals, checkpoints,
// manifests and reports. Each edit is one line and exit code 2, or changes nothing that matters.
#include <boost/test/unit_test.hpp>

#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "../support/bad_input.hpp"
#include "../support/killed.hpp"
#include "../support/program.hpp"
#include "../support/signed_again.hpp"

using namespace nysalt::test;
using json = nlohmann::ordered_json;

namespace {

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

/// A line of JSON, each member and element edited in several ways.
std::vector<edit> edits_of(const std::string& line) {
  const json sound = json::parse(line);
  std::vector<json::json_pointer> places;
  add_places(sound, json::json_pointer(), places);
  std::vector<edit> all;
  for (const auto& at : places) {
    const auto add = [&](const std::string& what, const json& document) {
      if (document != sound) all.push_back({at.to_string() + " " + what, document.dump()});
    };
    json missing = sound;
    json& parent = missing[at.parent_pointer()];
    if (parent.is_object()) {
      parent.erase(at.back());
    } else {
      parent.erase(static_cast<std::size_t>(std::stoul(at.back())));
    }
    add("missing", missing);
    for (const json& value : {json(nullptr), json::array(), json::array({1.0}), json("text"), json(-7)}) {
      json other = sound;
      other[at] = value;
      add(value.dump(), other);
    }
    if (sound[at].is_array() && !sound[at].empty()) {
      json shorter = sound;
      shorter[at].erase(shorter[at].size() - 1);
      add("shorter", shorter);
    }
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

/// Edits each part of the journal of a comparison, and resumes it.
void edit_journal_of(const std::string& name, const std::string& line) {
  const scratch folder(name);
  // The journal is whole while the report's pictures are drawn; a gnuplot that draws nothing keeps a copy.
  const auto kept =
      shell(folder,
            "printf '#!/bin/sh\\ncp ../journal.jsonl ../../kept\\nexit 1\\n' >gnuplot; chmod +x gnuplot; "
            "PATH=$PWD:$PATH \"$nysalt\" " +
                line + " --output out");
  BOOST_TEST_REQUIRE(kept.code == 0, kept.err);
  const std::string sound = contents(folder / "kept");
  const auto lines = lines_of(sound);
  BOOST_TEST_REQUIRE(lines.size() > 2U, kept.err);
  const auto resumed = [&](const std::string& text) {
    fs::remove_all(folder / "out");
    fs::create_directory(folder / "out");
    write(folder / "out/journal.jsonl", text);
    return shell(folder, "PATH=/nowhere \"$nysalt\" " + line + " --output out --resume");  // draws nothing
  };
  BOOST_TEST_REQUIRE(resumed(sound).code == 0);
  constexpr std::size_t every =
      3;  // each place has up to seven edits: of three neighbours one is tried, for time
  std::size_t refused = 0;
  std::size_t number = 0;
  for (std::size_t k = 1; k < lines.size(); ++k) {
    for (const auto& [what, text] : edits_of(lines[k])) {
      if (number++ % every != 0) continue;
      const bool is_of_checksum = what.starts_with("/checksum");
      const std::string line_again = is_of_checksum ? text : signed_line(text);
      std::string edited;
      for (std::size_t i = 0; i < lines.size(); ++i) edited += (i == k ? line_again : lines[i]) + "\n";
      const std::string shown = lines[k].substr(0, 60) + ": " + what;
      const auto done = resumed(edited);
      if (done.code == 2 || is_of_checksum) {
        require_refused(done, "cannot resume from out/journal.jsonl: ", shown);
        ++refused;
        continue;
      }
      BOOST_TEST((done.code == 0 || done.code == 3),
                 shown << " ended with " << done.code << ": " << done.err);
      BOOST_TEST(json::accept(contents(folder / "out/report.json")), shown);
      BOOST_TEST(fs::exists(folder / "out/report.html"), shown);
      BOOST_TEST(!fs::exists(folder / "out/journal.jsonl"), shown);
    }
  }
  BOOST_TEST(refused > 50U);
}

/// A document of lists in each other.
std::string deep(int depth, const std::string& before, const std::string& after) {
  const auto count = static_cast<std::size_t>(depth);
  return before + std::string(count, '[') + std::string(count, ']') + after + "\n";
}

}  // namespace

BOOST_AUTO_TEST_CASE(an_edited_journal_of_paths_is_refused_or_taken_whole) {
  edit_journal_of("edited_paths",
                  "compare --system pendulum --methods verlet,learned:bab3 --steps 0.2 --horizon 4 "
                  "--trajectories 8 --learn-trajectories 8 --learn-horizon 1 --learn-effort quick --metric "
                  "path,acceptance");
}

BOOST_AUTO_TEST_CASE(an_edited_journal_of_distributions_is_refused_or_taken_whole) {
  edit_journal_of("edited_distributions",
                  "compare --system oscillator --omega 1 --friction 0.5 --temperature 0.1 --methods baoab "
                  "--steps 0.2 --horizon 60 --trajectories 8 --bins 5 --metric acf,distribution");
}

BOOST_AUTO_TEST_CASE(an_edited_checkpoint_of_a_run_is_refused_or_gone_on_with) {
  const scratch folder("edited_run");
  const std::string line =
      "run --system pendulum --friction 0.1 --temperature 0.5 --method baoab --step 0.01 --horizon 4000 "
      "--trajectories 5 --sample-every 10000 --every 6400 --output out.csv --checkpoint c ";
  BOOST_TEST_REQUIRE(killed_at(folder, line, "c", 6400));
  const std::string sound = contents(folder / "c");
  const std::string part = contents(folder / "out.csv.part");
  const auto end = sound.find('\n');
  for (const auto& [what, head] : edits_of(sound.substr(0, end))) {
    write(folder / "c", signed_again(head + sound.substr(end)));
    write(folder / "out.csv.part", part);
    fs::remove(folder / "out.csv");
    const auto done = run(folder, line + "--resume");
    if (done.code != 0) require_refused(done, "", what);
  }
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
  const std::string sound = contents(folder / "c");
  const auto end = sound.find('\n');
  for (const auto& [what, head] : edits_of(sound.substr(0, end))) {
    write(folder / "c", signed_again(head + sound.substr(end)));
    const auto done = run(folder, line + "--resume");
    if (done.code != 0) require_refused(done, "", what);
  }
}

BOOST_AUTO_TEST_CASE(documents_that_are_too_deep_or_too_long_are_refused) {
  const scratch folder("deep");
  const std::string line = "run --system pendulum --method verlet --step 0.02 --horizon 1 --output o.csv";
  const std::string manifest = R"({"format":"nysalt manifest","version":1,"files":{"x":)";
  const std::string compare =
      "compare --system pendulum --methods verlet --steps 0.2 --horizon 2 "
      "--trajectories 4 --output out";
  BOOST_TEST_REQUIRE(run(folder, compare).code == 0);
  const std::string report = contents(folder / "out/report.json");
  for (const int depth : {100, 20'000, 1'000'000}) {
    write(folder / "manifest.json", deep(depth, manifest, "}}"));
    require_refused(run(folder, line), "manifest.json is no manifest", "manifest");
    require_refused(run(folder, "cite o.csv"), "cannot read o.csv", "manifest");
    fs::remove(folder / "manifest.json");
    write(folder / "x.csv", "t\n");
    write(folder / "x.csv.manifest.json", deep(depth, R"({"options":)", "}"));
    require_refused(run(folder, "cite x.csv"), "x.csv.manifest.json", "earlier manifest");
    write(folder / "scheme.json", deep(depth, R"({"format":)", "}"));
    require_refused(run(folder, "run --system pendulum --method scheme.json --step 0.1 --horizon 1"),
                    "scheme.json", "scheme");
    write(folder / "x.json", deep(depth, "", ""));
    require_refused(run(folder, "cite x.json"), "x.json", "document");
    for (const char* member : {"format", "version", "question", "command"}) {
      const json whole{{"format", "nysalt checkpoint"}, {"version", 1}, {"command", "run"}, {"nysalt", "0"}};
      json others = whole;
      others.erase(member);
      std::string head = others.dump();
      head.back() = ',';
      const std::string text = deep(depth, head + "\"" + member + "\":", "}") + "12345678\ncrc32 00000000\n";
      write(folder / "c", signed_again(text));
      require_refused(run(folder, line + " --checkpoint c --every 10 --resume"), "cannot read c", member);
    }
    // A report that cannot be read is made anew; a journal is not.
    write(folder / "out/report.json", deep(depth, R"({"question":)", "}"));
    BOOST_TEST(run(folder, compare + " --resume").code == 0);
    BOOST_TEST(json::accept(contents(folder / "out/report.json")));
    for (const std::string& journal :
         {deep(depth, R"({"format":"nysalt journal","question":)", "}"), deep(depth, "", "")}) {
      write(folder / "out/journal.jsonl", journal);
      require_refused(run(folder, compare + " --resume"), "is no journal", "journal");
      fs::remove(folder / "out/journal.jsonl");
    }
  }
  // Holes on the disk, which take no room there.
  write(folder / "manifest.json", manifest);
  fs::resize_file(folder / "manifest.json", std::uintmax_t{1} << 33U);
  require_refused(run(folder, line), "too large to be read", "long manifest");
  fs::remove(folder / "manifest.json");
  write(folder / "out/journal.jsonl", "");
  fs::resize_file(folder / "out/journal.jsonl", std::uintmax_t{1} << 33U);
  require_refused(run(folder, compare + " --resume"), "a journal must be at most", "long journal");
  fs::remove(folder / "out/journal.jsonl");
  for (const std::string& head : {std::string(R"({"format":"nysalt checkpoint)"),
                                  std::string("{\"format\":\"nysalt checkpoint\",\"version\":1}\n")}) {
    write(folder / "c", head);
    fs::resize_file(folder / "c", std::uintmax_t{1} << 33U);
    require_refused(run(folder, line + " --checkpoint c --every 10 --resume"), "cannot read c", head);
  }
  // Names of members are compared with each other.
  std::string names = "{";
  for (int k = 0; k < 1'000'000; ++k) names += "\"" + std::to_string(k) + "\":0,";
  write(folder / "manifest.json", names + "\"x\":0}");
  require_refused(run(folder, line), "is no manifest", "names");
}

// A resume is of the same starts, not of as many.
BOOST_AUTO_TEST_CASE(edited_starts_are_another_question) {
  const scratch folder("edited_starts");
  for (const std::string line :
       {"run --system pendulum --method verlet --step 0.1 --horizon 100 --output o.csv --checkpoint c "
        "--every 64 ",
        "compare --system pendulum --methods verlet --steps 0.1 --horizon 2 --output r "}) {
    const std::string command = line + "--trajectories 8 --temperature 1 --start s.csv";
    write(folder / "s.csv", "q1\n0.1\n0.2\n");
    BOOST_TEST_REQUIRE(run(folder, command).code == 0);
    BOOST_TEST(run(folder, command + " --resume").code == 0);
    write(folder / "s.csv", "q1\n0.1\n0.3\n");
    require_refused(run(folder, command + " --resume"), "starts", line);
  }
}

BOOST_AUTO_TEST_CASE(what_is_no_regular_file_is_not_waited_for) {
  const scratch folder("no_regular_files");
  const std::string line = "run --system pendulum --method verlet --step 0.02 --horizon 1 ";
  for (const char* make : {"mkfifo", "mkdir", "ln -s /dev/zero"}) {
    const auto in_its_place = [&](const std::string& name, const std::string& arguments) {
      fs::remove_all(folder / name);
      BOOST_TEST_REQUIRE(shell(folder, std::string(make) + " " + name).code == 0);
      const auto done = shell(folder, "\"$nysalt\" " + arguments, 20);
      fs::remove_all(folder / name);
      return done;
    };
    for (const auto& [name, arguments] : std::vector<std::pair<std::string, std::string>>{
             {"m.json", "run --system pendulum --method m.json --step 0.02 --horizon 1"},
             {"d.csv", "sample --system logistic_regression --data d.csv --draws 10"},
             {"s.csv", line + "--start s.csv"},
             {"o.toml", line + "--config o.toml"},
             {"o.toml", "run --config o.toml"},
             {"x.hpp", "run --system ./x.hpp --method verlet --step 0.02 --horizon 1"},
             {"manifest.json", line + "--output o.csv"},
             {"c", line + "--output o.csv --checkpoint c --every 10 --resume"}}) {
      require_refused(in_its_place(name, arguments), name, std::string(make) + " " + name);
    }
    // Of earlier versions, which had a manifest beside each file.
    const auto earlier = in_its_place("o.csv.manifest.json", line + "--output o.csv");
    BOOST_TEST(earlier.code == 0, make << ": " << earlier.err);
    require_refused(in_its_place("x.csv.manifest.json", "cite x.csv"), "x.csv", make);
  }
  // Pipes of the shell are what it was asked to read.
  write(folder / "t.json",
        R"({"format":"nysalt table","version":1,"letters":"ABA","coefficients":[0.5,1,0.5]})");
  const std::string method = "\"$nysalt\" run --system pendulum --method /dev/stdin --step 0.02 --horizon 1";
  BOOST_TEST(shell(folder, "cat t.json | " + method).code == 0);
  BOOST_TEST(shell(folder, method + " <t.json").code == 0);
  BOOST_TEST(
      shell(folder, "\"$nysalt\" run --system pendulum --method /dev/fd/3 --step 0.02 --horizon 1 3<t.json")
          .code == 0);
  BOOST_TEST(shell(folder, "echo trajectories=2 | \"$nysalt\" " + line + "--config /dev/stdin").code == 0);
}

BOOST_AUTO_TEST_CASE(no_text_of_a_file_ends_a_message) {
  const scratch folder("texts_of_files");
  const std::string line = "sample --system logistic_regression --draws 10 --data d.csv";
  const auto told = [&](const std::string& text, const std::string& words) {
    write(folder / "d.csv", text);
    require_refused(run(folder, line), words, words);
  };
  const auto unreadable = [](std::size_t bytes) { return "got '" + std::string(bytes, '?') + "'"; };
  told(std::string("a,b\n1,x\0y\n", 10), "b must be a finite number, got 'x y'");
  told(std::string("\xff\xfe"
                   "a\0,\0b\0\n\0"
                   "1\0,\0"
                   "0\0\n\0",
                   18),
       "got '");
  told("a,b\n1,\xed\xa0\x80\n", unreadable(3));      // half a pair of UTF-16
  told("a,b\n1,\xc0\x80\n", unreadable(2));          // NUL in two bytes
  told("a,b\n1,\xf4\x90\x80\x80\n", unreadable(4));  // beyond Unicode
  told(
      "a,b\n1,\xc2\x9b"
      "31m\n",
      "got ' 31m'");  // a control that terminals obey
  told("a,b\n1,\xd0\xb6\n", "got '\xd0\xb6'");
}
