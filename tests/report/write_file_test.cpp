// SPDX-License-Identifier: BSL-1.0
// A file is written whole or not at all.
#include <sys/resource.h>
#include <sys/stat.h>

#include <boost/test/unit_test.hpp>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "../../src/report/write_file.hpp"
#include "../support/refusal.hpp"
#include "../support/scratch.hpp"
#include "nysalt/atomic_file.hpp"
#include "nysalt/detail/write_failure.hpp"

using namespace nysalt;
using namespace nysalt::test;
using names = std::set<std::string>;

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
    return refuses<std::runtime_error>([&] { write_file(path, "text"); },
                                       {"cannot write", path.string(), "folder"});
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

BOOST_AUTO_TEST_CASE(a_full_disk_is_told) {
  const scratch folder("write_file");
  write_file(folder / "a.txt", "before");
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit little{1000, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &little);  // write() then fails with EFBIG
  const bool is_told = refuses<std::runtime_error>(
      [&] { write_file(folder / "a.txt", std::string(100'000, 'x')); }, {"cannot write", "full"});
  setrlimit(RLIMIT_FSIZE, &before);
  BOOST_TEST(is_told);
  BOOST_TEST(contents(folder / "a.txt") == "before");
  BOOST_TEST((folder.files() == names{"a.txt"}));
}

BOOST_AUTO_TEST_CASE(what_is_in_the_way_is_not_followed) {
  const scratch folder("write_file_way");
  write_file(folder / "precious", "kept");
  std::filesystem::create_symlink("precious", folder / "a.txt.new.part");
  BOOST_TEST(
      refuses<std::runtime_error>([&] { write_file(folder / "a.txt", "text"); }, {"is not a regular file"}));
  BOOST_TEST(contents(folder / "precious") == "kept");
  std::filesystem::remove(folder / "a.txt.new.part");
  BOOST_TEST(mkfifo((folder / "a.txt.new.part").c_str(), 0600) == 0);
  BOOST_TEST(
      refuses<std::runtime_error>([&] { write_file(folder / "a.txt", "text"); }, {"is not a regular file"}));
  std::filesystem::remove(folder / "a.txt.new.part");
  std::ofstream(folder / "a.txt.new.part") << "left by a process that was stopped";
  write_file(folder / "a.txt", "text");
  BOOST_TEST(contents(folder / "a.txt") == "text");
  BOOST_TEST((folder.files() == names{"a.txt", "precious"}));
}

BOOST_AUTO_TEST_CASE(what_is_no_regular_file_is_not_replaced) {
  const scratch folder("write_file_node");
  const auto refused = [&](const std::string& name, const std::string& why) {
    return refuses<std::runtime_error>([&] { write_file(folder / name, "text"); }, {"cannot write", why});
  };
  BOOST_TEST(mkfifo((folder / "fifo").c_str(), 0600) == 0);
  std::filesystem::create_symlink("fifo", folder / "link");
  std::filesystem::create_symlink("loop", folder / "loop");
  for (const char* name : {"fifo", "link"}) BOOST_TEST(refused(name, "is not a regular file"));
  BOOST_TEST(refused("loop", "leads back to itself"));
  BOOST_TEST(refused(std::string("a\0b", 3), "no zero byte"));
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
  BOOST_TEST(refuses<std::runtime_error>([&] { write_file(folder / "a.txt", "second"); },
                                         {"another process writes it"}));
  first.commit();
  BOOST_TEST(contents(folder / "a.txt") == "first");
  write_file(folder / "a.txt", "second");
  BOOST_TEST(contents(folder / "a.txt") == "second");
}

BOOST_AUTO_TEST_CASE(what_took_the_place_of_the_part_stays) {
  const scratch folder("write_file_place");
  const auto replace = [&] {
    std::ofstream(folder / "x") << "other";
    std::filesystem::rename(folder / "x", folder / "a.txt.new.part");
  };
  {
    atomic_file file(folder / "a.txt");
    file.write("text");
    replace();
    BOOST_TEST(refuses<detail::write_failure>([&] { file.commit(); }, {"removed or replaced"}));
  }
  BOOST_TEST(contents(folder / "a.txt.new.part") == "other");
  BOOST_TEST((folder.files() == names{"a.txt.new.part"}));
}
