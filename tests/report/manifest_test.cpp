// SPDX-License-Identifier: BSL-1.0
// One manifest for each folder: concurrent writers lose no entry, and no file of another program is replaced.
#include <boost/test/unit_test.hpp>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "../../src/comparison/inputs.hpp"
#include "../../src/comparison/refusal.hpp"
#include "../../src/report/manifest.hpp"
#include "../support/refusal.hpp"
#include "../support/scratch.hpp"
#include "nysalt/atomic_file.hpp"
#include "nysalt/detail/write_failure.hpp"

using namespace nysalt;
using namespace nysalt::program;
using namespace nysalt::test;

namespace {

common_settings made_by(const std::string& command) {
  common_settings common;
  common.command = command;
  common.options = "run.step=0.1\n";
  return common;
}

json entries(const scratch& folder) { return entries_in(folder / "manifest.json"); }

}  // namespace

BOOST_AUTO_TEST_CASE(entries_of_other_files_stay_and_its_own_is_replaced) {
  const scratch folder("manifest_entries");
  write_result(folder / "a.csv", "1\n", made_by("first"));
  write_result(folder / "b.csv", "2\n", made_by("second"));
  BOOST_TEST(entries(folder).size() == 2U);
  BOOST_TEST(entries(folder)["a.csv"]["command"] == "first");
  write_result(folder / "a.csv", "3\n", made_by("third"));
  BOOST_TEST(entries(folder).size() == 2U);
  BOOST_TEST(entries(folder)["a.csv"]["command"] == "third");
  BOOST_TEST(entries(folder)["a.csv"]["file"] == "a.csv");
  BOOST_TEST(entries(folder)["b.csv"]["command"] == "second");
  record_results({folder / "b.csv", folder / "c.npy"}, made_by("fourth"), {{"axes", 3}});
  BOOST_TEST(entries(folder)["c.npy"]["axes"] == 3);
  BOOST_TEST(entries(folder).size() == 3U);
  BOOST_TEST((folder.files() == std::set<std::string>{"a.csv", "b.csv", "manifest.json"}));
}

BOOST_AUTO_TEST_CASE(without_a_command_there_is_no_manifest) {
  const scratch folder("manifest_none");
  write_result(folder / "a.csv", "1\n", {});
  BOOST_TEST((folder.files() == std::set<std::string>{"a.csv"}));
}

BOOST_AUTO_TEST_CASE(many_that_write_at_once_lose_nothing) {
  const scratch folder("manifest_at_once");
  constexpr int writers = 8;
  constexpr int files = 10;
  std::vector<std::thread> all;
  for (int i = 0; i < writers; ++i) {
    all.emplace_back([&folder, i] {
      for (int k = 0; k < files; ++k) {
        const std::string name = std::to_string(i) + "_" + std::to_string(k);
        write_result(folder / name, "x", made_by(name));
      }
    });
  }
  for (auto& one : all) one.join();
  const json found = entries(folder);
  BOOST_TEST(found.size() == static_cast<std::size_t>(writers * files));
  for (const auto& [name, entry] : found.items()) BOOST_TEST(entry["command"] == name);
}

// Were the entries read before the lock is taken, that of the other process would be lost.
BOOST_AUTO_TEST_CASE(an_entry_that_is_written_meanwhile_stays) {
  const scratch folder("manifest_meanwhile");
  write_result(folder / "a.csv", "1\n", made_by("first"));
  std::thread waiting;
  {
    atomic_file held(folder / "manifest.json");
    waiting = std::thread([&] { write_result(folder / "b.csv", "2\n", made_by("second")); });
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    BOOST_TEST(entries(folder).size() == 1U);
    json all = json::parse(contents(folder / "manifest.json"));
    all["files"]["c.csv"] = {{"command", "third"}};
    held.write(all.dump());
    held.commit();
  }
  waiting.join();
  BOOST_TEST(entries(folder).size() == 3U);
  BOOST_TEST(entries(folder)["c.csv"]["command"] == "third");
}

BOOST_AUTO_TEST_CASE(a_writer_that_never_ends_is_not_waited_for_without_end) {
  const scratch folder("manifest_patience");
  const atomic_file held(folder / "manifest.json");
  write_file(folder / "a.csv", "1\n");
  BOOST_TEST(refuses<nysalt::detail::write_failure>(
      [&] { record_results({folder / "a.csv"}, made_by("first"), {}, std::chrono::milliseconds(20)); },
      {"a.csv, which is whole: ", "another process writes it"}));
}

BOOST_AUTO_TEST_CASE(what_is_not_ours_is_never_replaced) {
  for (const std::string text :
       {"{\"name\": \"a web page\"}", "[]", "not json", "", "{\"format\": \"nysalt manifest\"}",
        "{\"format\": \"nysalt manifest\", \"version\": 2, \"files\": {}}",
        "{\"format\": \"nysalt manifest\", \"version\": 1, \"files\": []}"}) {
    const scratch folder("manifest_foreign");
    std::ofstream(folder / "manifest.json") << text;
    BOOST_TEST(
        refuses<refusal>([&] { require_manifest(folder / "a.csv"); }, {"cannot write", "manifest.json"}));
    BOOST_TEST(refuses<nysalt::detail::write_failure>(
        [&] { write_result(folder / "a.csv", "1\n", made_by("first")); },
        {"a.csv, which is whole: ", "manifest.json"}));
    BOOST_TEST(contents(folder / "manifest.json") == text);
    BOOST_TEST(contents(folder / "a.csv") == "1\n");
  }
  const scratch folder("manifest_ours");
  write_result(folder / "a.csv", "1\n", made_by("first"));
  require_manifest(folder / "b.csv");
  BOOST_TEST(refuses<refusal>([&] { require_manifest(folder / "manifest.json"); }, {"manifest.json"}));
  std::filesystem::create_directories(folder / "c" / "manifest.json");
  BOOST_TEST(refuses<refusal>([&] { require_manifest(folder / "c" / "a.csv"); }, {"folder"}));
}

// What is written to a link goes to where the link leads.
BOOST_AUTO_TEST_CASE(a_link_to_a_manifest_is_refused) {
  const scratch folder("manifest_link");
  write_result(folder / "a.csv", "1\n", made_by("first"));
  std::filesystem::create_symlink("manifest.json", folder / "link");
  std::filesystem::create_symlink("link", folder / "link_to_link");
  std::filesystem::create_symlink("a.csv", folder / "to_a");
  for (const char* name : {"link", "link_to_link"}) {
    BOOST_TEST(refuses<refusal>([&] { require_manifest(folder / name); }, {"cannot write", name}));
  }
  require_manifest(folder / "to_a");
}

BOOST_AUTO_TEST_CASE(earlier_pictures_that_were_made_here_go) {
  const scratch folder("manifest_pictures");
  const auto earlier = [](const std::string& file) {
    return json{{"file", file}, {"command", "old"}, {"options", ""}, {"versions", {}}}.dump();
  };
  for (const char* name : {"p.svg", "p.gp", "q.svg"}) {
    write_file(folder / name, "x");
    write_file(folder / (std::string(name) + ".manifest.json"), earlier(name));
  }
  write_file(folder / "p.png", "not ours");
  write_file(folder / "p.dat", "an input");
  write_file(folder / "p.dat.manifest.json", earlier("p.dat"));
  note_input(folder / "p.dat");
  remove_earlier_pictures({"p", {}}, folder.path());
  BOOST_TEST((folder.files() == std::set<std::string>{"p.dat", "p.png", "q.svg", "q.svg.manifest.json"}));
}

BOOST_AUTO_TEST_CASE(an_earlier_manifest_of_the_same_file_goes_and_others_stay) {
  const scratch folder("manifest_earlier");
  const auto earlier = [](const std::string& file) {
    return json{{"file", file}, {"command", "old"}, {"options", ""}, {"versions", {}}}.dump();
  };
  write_file(folder / "a.csv.manifest.json", earlier("a.csv"));
  write_file(folder / "b.csv.manifest.json", earlier("b.csv"));
  write_file(folder / "c.csv.manifest.json", "{\"mine\": true}");
  write_file(folder / "d.csv.manifest.json", earlier("d.csv"));
  note_input(folder / "d.csv.manifest.json");
  for (const char* name : {"a.csv", "c.csv", "d.csv"}) write_result(folder / name, "1\n", made_by("new"));
  BOOST_TEST(
      (folder.files() == std::set<std::string>{"a.csv", "b.csv.manifest.json", "c.csv", "c.csv.manifest.json",
                                               "d.csv", "d.csv.manifest.json", "manifest.json"}));
}
