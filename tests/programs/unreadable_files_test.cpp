// SPDX-License-Identifier: BSL-1.0
// Documents that are too deep or too long to be read; other files that cannot be: cases/unreadable_files.txt.
#include <boost/test/unit_test.hpp>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "../support/forged.hpp"
#include "../support/program.hpp"

using namespace nysalt::test;
using json = nlohmann::ordered_json;

namespace {

namespace fs = std::filesystem;

/// A document of lists in each other.
std::string deep(std::size_t depth, const std::string& before, const std::string& after) {
  return before + std::string(depth, '[') + std::string(depth, ']') + after + "\n";
}

}  // namespace

BOOST_AUTO_TEST_CASE(documents_that_are_too_deep_or_too_long_are_refused) {
  const scratch folder("deep");
  const std::string line = "run --system pendulum --method verlet --step 0.02 --horizon 1 --output o.csv";
  const std::string resume = line + " --checkpoint c --every 10 --resume";
  const std::string manifest = R"({"format":"nysalt manifest","version":1,"files":{"x":)";
  const std::string compare =
      "compare --system pendulum --methods verlet --steps 0.2 --horizon 2 --trajectories 4 --output out";
  BOOST_TEST_REQUIRE(run(folder, compare).code == 0);
  /// The command is refused while the file has that text, and that length if one is given.
  const auto refused = [&](const std::string& file, const std::string& text, const std::string& arguments,
                           const char* words, std::uintmax_t length = 0) {
    std::ofstream(folder / file, std::ios::binary) << text;
    if (length > 0) fs::resize_file(folder / file, length);
    all_refused(folder, {{arguments, {words}}});
    BOOST_TEST(run(folder, arguments).err.find("json.exception") == std::string::npos);
    fs::remove(folder / file);
  };
  std::ofstream(folder / "x.csv") << "t\n";
  for (const std::size_t depth : {20'000U, 1'000'000U}) {
    refused("manifest.json", deep(depth, manifest, "}}"), line, "manifest.json is no manifest");
    refused("manifest.json", deep(depth, manifest, "}}"), "cite o.csv", "cannot read o.csv");
    refused("x.csv.manifest.json", deep(depth, R"({"options":)", "}"), "cite x.csv", "x.csv.manifest.json");
    refused("scheme.json", deep(depth, R"({"format":)", "}"),
            "run --system pendulum --method scheme.json --step 0.1 --horizon 1", "scheme.json");
    refused("x.json", deep(depth, "", ""), "cite x.json", "x.json");
    for (const char* member : {"format", "version", "question", "command"}) {
      json others{{"format", "nysalt checkpoint"}, {"version", 1}, {"command", "run"}, {"nysalt", "0"}};
      others.erase(member);
      std::string head = others.dump();
      head.back() = ',';
      head += "\"" + std::string(member) + "\":";
      refused("c", signed_again(deep(depth, head, "}") + "12345678\ncrc32 00000000\n"), resume,
              "cannot read c");
    }
    // A report that cannot be read is made anew; a journal is not.
    std::ofstream(folder / "out/report.json") << deep(depth, R"({"question":)", "}");
    BOOST_TEST(run(folder, compare + " --resume").code == 0);
    BOOST_TEST(json::accept(contents(folder / "out/report.json")));
    refused("out/journal.jsonl", deep(depth, R"({"format":"nysalt journal","question":)", "}"),
            compare + " --resume", "is no journal");
    refused("out/journal.jsonl", deep(depth, "", ""), compare + " --resume", "is no journal");
  }
  // Holes on the disk, which take no room there.
  constexpr std::uintmax_t long_file = std::uintmax_t{1} << 33U;
  refused("manifest.json", manifest, line, "too large to be read", long_file);
  refused("out/journal.jsonl", "", compare + " --resume", "a journal must be at most", long_file);
  refused("c", R"({"format":"nysalt checkpoint)", resume, "cannot read c", long_file);
  refused("c", "{\"format\":\"nysalt checkpoint\",\"version\":1}\n", resume, "cannot read c", long_file);
  // Names of members are compared with each other.
  std::string names = "{";
  for (int k = 0; k < 1'000'000; ++k) names += "\"" + std::to_string(k) + "\":0,";
  refused("manifest.json", names + "\"x\":0}", line, "is no manifest");
}
