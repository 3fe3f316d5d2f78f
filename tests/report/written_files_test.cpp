// SPDX-License-Identifier: BSL-1.0
// A file is written whole or not at all, and says how it was made.
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "../../src/report/result_file.hpp"
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
  common.options = "compare.step=0.1\n";
  return common;
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

BOOST_AUTO_TEST_CASE(a_result_says_how_it_was_made) {
  const scratch folder("provenance");
  const common_settings common = made_by("nysalt compare --step 0.1");
  write_document(folder / "a.json", {{"rows", 1}}, common);
  const json document = json::parse(contents(folder / "a.json"));
  BOOST_TEST(document["rows"] == 1);
  std::set<std::string> members;
  for (const auto& [name, value] : document["provenance"].items()) members.insert(name);
  BOOST_TEST((members == names{"command", "options", "seed", "versions", "compiler", "flags", "time"}));
  BOOST_TEST(document["provenance"]["command"] == common.command);
  BOOST_TEST(document["provenance"]["options"] == common.options);
  BOOST_TEST((folder.files() == names{"a.json"}));
}

BOOST_AUTO_TEST_CASE(a_table_says_it_in_its_first_line) {
  const scratch folder("provenance_of_table");
  const auto written = [&](const std::string& command, const std::string& more) {
    common_settings common = made_by(command);
    common.options += more;
    write_table(folder / "a.csv", "x\n1\n", common);
    return contents(folder / "a.csv");
  };
  const std::string once = written("nysalt compare", "");
  const auto end = once.find('\n');
  BOOST_TEST(once.substr(end + 1) == "x\n1\n");
  BOOST_TEST(once.starts_with(mark_of_table));
  const json made = json::parse(once.substr(mark_of_table.size(), end - mark_of_table.size()));
  BOOST_TEST(made["options"] == "compare.step=0.1\n");
  BOOST_TEST(!made.contains("time"));
  // The same work, gone on with.
  BOOST_TEST(written("nysalt compare --resume", "compare.resume=true\ncompare.threads=3\n") == once);
  BOOST_TEST(written("nysalt compare --spread 2", "compare.spread=2\n") != once);
}

BOOST_AUTO_TEST_CASE(without_a_command_nothing_is_added) {
  const scratch folder("provenance_none");
  write_document(folder / "a.json", {{"rows", 1}}, {});
  write_table(folder / "a.csv", "x\n1\n", {});
  BOOST_TEST(contents(folder / "a.json") == text_of({{"rows", 1}}));
  BOOST_TEST(contents(folder / "a.csv") == "x\n1\n");
}
