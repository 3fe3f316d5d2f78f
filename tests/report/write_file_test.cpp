// SPDX-License-Identifier: BSL-1.0
// A file is written whole or not at all.
#include <fmt/format.h>
#include <unistd.h>
#include <boost/test/unit_test.hpp>

#include "../../src/report/write_file.hpp"
#include "../support/refusal.hpp"
#include "../support/scratch.hpp"

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

// A device that is always full, where the system has one.
BOOST_AUTO_TEST_CASE(a_full_disk_is_told) {
  if (!std::filesystem::is_character_file("/dev/full")) return;
  const scratch folder("write_file");
  write_file(folder / "a.txt", "before");
  std::filesystem::create_symlink("/dev/full", folder / fmt::format("a.txt.{}.part", getpid()));
  BOOST_TEST(refuses<std::runtime_error>([&] { write_file(folder / "a.txt", std::string(100'000, 'x')); },
                                         {"cannot write", "full"}));
  BOOST_TEST(contents(folder / "a.txt") == "before");
  BOOST_TEST((folder.files() == names{"a.txt"}));
}
