// SPDX-License-Identifier: BSL-1.0
// A file is written whole or not at all, and each folder has one manifest, in which concurrent writers lose
// no entry.
#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "../../src/comparison/inputs.hpp"
#include "../../src/comparison/refusal.hpp"
#include "../../src/report/manifest.hpp"
#include "../../src/report/write_file.hpp"
#include "../support/refusal.hpp"
#include "../support/scratch.hpp"
#include "nysalt/atomic_file.hpp"

using namespace nysalt;
using namespace nysalt::test;
using names = std::set<std::string>;
using namespace nysalt::program;

namespace {

bool not_written(const std::filesystem::path& path, std::initializer_list<std::string_view> why) {
  return refuses<std::runtime_error>([&] { write_file(path, "text"); }, why);
}

common_settings made_by(const std::string& command) {
  common_settings common;
  common.command = command;
  common.options = "run.step=0.1\n";
  return common;
}

json entries(const scratch& folder) { return entries_in(folder / "manifest.json"); }

/// What an earlier version wrote beside each file.
std::string earlier(const std::string& file) {
  return json{{"file", file}, {"command", "old"}, {"options", ""}, {"versions", {}}}.dump();
}

}  // namespace

BOOST_AUTO_TEST_CASE(what_is_written_can_be_read) {
  const scratch folder("write_file");
  const std::string bytes("line\r\n\0\xff end", 13);
  write_file(folder / "a.txt", bytes);
  BOOST_TEST(contents(folder / "a.txt") == bytes);
  write_file(folder / "a.txt", "shorter");
  BOOST_TEST(contents(folder / "a.txt") == "shorter");
  write_file(folder / "empty", "");
  BOOST_TEST((folder.files() == names{"a.txt", "empty"}));
}

BOOST_AUTO_TEST_CASE(where_it_cannot_be_written_nothing_is_left) {
  const scratch folder("write_file");
  write_file(folder / "file", "here");
  const auto refused = [&](const std::filesystem::path& path) {
    return not_written(path, {"cannot write", path.string(), "folder"});
  };
  BOOST_TEST(refused(folder / "nowhere" / "a.txt"));
  BOOST_TEST(refused(folder / "file" / "a.txt"));
  std::filesystem::create_directory(folder / "occupied");  // a folder, not empty, cannot be replaced
  write_file(folder / "occupied" / "inside", "kept");
  BOOST_TEST(refused(folder / "occupied"));
  BOOST_TEST((folder.files() == names{"file", "occupied"}));
  BOOST_TEST(contents(folder / "file") == "here");
  BOOST_TEST(contents(folder / "occupied" / "inside") == "kept");
}

BOOST_AUTO_TEST_CASE(what_is_in_the_way_is_not_followed) {
  const scratch folder("write_file_way");
  write_file(folder / "precious", "kept");
  std::filesystem::create_symlink("precious", folder / "a.txt.new.part");
  BOOST_TEST(not_written(folder / "a.txt", {"is not a regular file"}));
  BOOST_TEST(contents(folder / "precious") == "kept");
  std::filesystem::remove(folder / "a.txt.new.part");
  BOOST_TEST(mkfifo((folder / "a.txt.new.part").c_str(), 0600) == 0);
  BOOST_TEST(not_written(folder / "a.txt", {"is not a regular file"}));
  std::filesystem::remove(folder / "a.txt.new.part");
  std::ofstream(folder / "a.txt.new.part") << "left by a process that was stopped";
  write_file(folder / "a.txt", "text");
  BOOST_TEST(contents(folder / "a.txt") == "text");
  BOOST_TEST((folder.files() == names{"a.txt", "precious"}));
}

BOOST_AUTO_TEST_CASE(what_is_no_regular_file_is_not_replaced) {
  const scratch folder("write_file_node");
  BOOST_TEST(mkfifo((folder / "fifo").c_str(), 0600) == 0);
  std::filesystem::create_symlink("fifo", folder / "link");
  std::filesystem::create_symlink("loop", folder / "loop");
  for (const char* name : {"fifo", "link"}) {
    BOOST_TEST(not_written(folder / name, {"cannot write", "is not a regular file"}));
  }
  BOOST_TEST(not_written(folder / "loop", {"leads back to itself"}));
  BOOST_TEST(not_written(folder / std::string("a\0b", 3), {"no zero byte"}));
  BOOST_TEST(std::filesystem::is_fifo(folder / "fifo"));
  // What was made while the file was written.
  atomic_file late(folder / "late");
  late.write("text");
  BOOST_TEST(mkfifo((folder / "late").c_str(), 0600) == 0);
  BOOST_TEST(refuses<detail::write_failure>([&] { late.commit(); }, {"is not a regular file"}));
  BOOST_TEST(std::filesystem::is_fifo(folder / "late"));
  BOOST_TEST((folder.files() == names{"fifo", "late", "late.new.part", "link", "loop"}));
}

BOOST_AUTO_TEST_CASE(a_link_is_followed) {
  const scratch folder("write_file_link");
  std::filesystem::create_directory(folder / "inner");
  std::filesystem::create_symlink("inner/b.txt", folder / "a.txt");
  write_file(folder / "a.txt", "new");
  BOOST_TEST(std::filesystem::is_symlink(folder / "a.txt"));
  BOOST_TEST(contents(folder / "inner" / "b.txt") == "new");
  write_file(folder / "a.txt", "newer");
  BOOST_TEST(contents(folder / "inner" / "b.txt") == "newer");
}

BOOST_AUTO_TEST_CASE(of_two_writers_the_second_is_refused) {
  const scratch folder("write_file_two");
  atomic_file first(folder / "a.txt");
  first.write("first");
  BOOST_TEST(not_written(folder / "a.txt", {"another process writes it"}));
  first.commit();
  BOOST_TEST(contents(folder / "a.txt") == "first");
  write_file(folder / "a.txt", "second");
  BOOST_TEST(contents(folder / "a.txt") == "second");
}

BOOST_AUTO_TEST_CASE(what_took_the_place_of_the_part_stays) {
  const scratch folder("write_file_place");
  {
    atomic_file file(folder / "a.txt");
    file.write("text");
    std::ofstream(folder / "x") << "other";
    std::filesystem::rename(folder / "x", folder / "a.txt.new.part");
    BOOST_TEST(refuses<detail::write_failure>([&] { file.commit(); }, {"removed or replaced"}));
  }
  BOOST_TEST(contents(folder / "a.txt.new.part") == "other");
  BOOST_TEST((folder.files() == names{"a.txt.new.part"}));
}

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
  BOOST_TEST((folder.files() == names{"a.csv", "b.csv", "manifest.json"}));
  const scratch no_command("manifest_none");
  write_result(no_command / "a.csv", "1\n", {});
  BOOST_TEST((no_command.files() == names{"a.csv"}));
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
  // What is written to a link goes to where the link leads.
  std::filesystem::create_symlink("manifest.json", folder / "link");
  std::filesystem::create_symlink("link", folder / "link_to_link");
  std::filesystem::create_symlink("a.csv", folder / "to_a");
  for (const char* name : {"link", "link_to_link"}) {
    BOOST_TEST(refuses<refusal>([&] { require_manifest(folder / name); }, {"cannot write", name}));
  }
  require_manifest(folder / "to_a");
  std::filesystem::create_directories(folder / "c" / "manifest.json");
  BOOST_TEST(refuses<refusal>([&] { require_manifest(folder / "c" / "a.csv"); }, {"folder"}));
}

BOOST_AUTO_TEST_CASE(earlier_pictures_that_were_made_here_go) {
  const scratch folder("manifest_pictures");
  for (const char* name : {"p.svg", "p.gp", "q.svg"}) {
    write_file(folder / name, "x");
    write_file(folder / (std::string(name) + ".manifest.json"), earlier(name));
  }
  write_file(folder / "p.png", "not ours");
  write_file(folder / "p.dat", "an input");
  write_file(folder / "p.dat.manifest.json", earlier("p.dat"));
  note_input(folder / "p.dat");
  remove_earlier_pictures({"p", {}}, folder.path());
  BOOST_TEST((folder.files() == names{"p.dat", "p.png", "q.svg", "q.svg.manifest.json"}));
}

BOOST_AUTO_TEST_CASE(an_earlier_manifest_of_the_same_file_goes_and_others_stay) {
  const scratch folder("manifest_earlier");
  write_file(folder / "a.csv.manifest.json", earlier("a.csv"));
  write_file(folder / "b.csv.manifest.json", earlier("b.csv"));
  write_file(folder / "c.csv.manifest.json", "{\"mine\": true}");
  write_file(folder / "d.csv.manifest.json", earlier("d.csv"));
  note_input(folder / "d.csv.manifest.json");
  for (const char* name : {"a.csv", "c.csv", "d.csv"}) write_result(folder / name, "1\n", made_by("new"));
  BOOST_TEST((folder.files() == names{"a.csv", "b.csv.manifest.json", "c.csv", "c.csv.manifest.json", "d.csv",
                                      "d.csv.manifest.json", "manifest.json"}));
}
