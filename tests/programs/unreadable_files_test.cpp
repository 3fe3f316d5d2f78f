// SPDX-License-Identifier: BSL-1.0
// Files that are no regular ones, have no text, or are too deep or too long to be read.
#include <boost/test/unit_test.hpp>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "../support/forged.hpp"
#include "../support/program.hpp"
#include "../support/table.hpp"

using namespace nysalt::test;
using json = nlohmann::ordered_json;

namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

void require_refused(const finished& done, const std::string& words, const std::string& what) {
  BOOST_TEST(done.code == 2, what << " ended with " << done.code << ": " << done.err);
  BOOST_TEST(is_one_line(done.err), what << ": " << done.err);
  BOOST_TEST(done.err.starts_with("nysalt: "), what << ": " << done.err);
  BOOST_TEST(done.err.find(words) != std::string::npos, what << ": " << done.err);
  BOOST_TEST(done.err.find("json.exception") == std::string::npos, what << ": " << done.err);
}

/// A document of lists in each other.
std::string deep(int depth, const std::string& before, const std::string& after) {
  const auto count = static_cast<std::size_t>(depth);
  return before + std::string(count, '[') + std::string(count, ']') + after + "\n";
}

}  // namespace

BOOST_AUTO_TEST_CASE(unreadable_files) { run_table("unreadable_files"); }

BOOST_AUTO_TEST_CASE(documents_that_are_too_deep_or_too_long_are_refused) {
  const scratch folder("deep");
  const std::string line = "run --system pendulum --method verlet --step 0.02 --horizon 1 --output o.csv";
  const std::string manifest = R"({"format":"nysalt manifest","version":1,"files":{"x":)";
  const std::string compare =
      "compare --system pendulum --methods verlet --steps 0.2 --horizon 2 "
      "--trajectories 4 --output out";
  BOOST_TEST_REQUIRE(run(folder, compare).code == 0);
  const std::string report = contents(folder / "out/report.json");
  for (const int depth : {20'000, 1'000'000}) {
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
