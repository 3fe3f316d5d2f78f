// SPDX-License-Identifier: BSL-1.0
// What is written as a checkpoint can be read again: what would be too large for that is refused before.
#include <boost/test/unit_test.hpp>

#include <sys/mman.h>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "../support/refusal.hpp"
#include "../support/scratch.hpp"
#include "comparison/refusal.hpp"
#include "nysalt/atomic_file.hpp"
#include "program/output/checkpoint_file.hpp"

using namespace nysalt;
using namespace nysalt::program;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE(what_is_written_is_read_again) {
  const scratch folder("checkpoint_file");
  const std::vector<double> numbers{0.5, -1.0, 3.0};
  write_checkpoint_file(folder / "c", {{"command", "run"}, {"question", 7}}, numbers);
  BOOST_TEST(head_of_checkpoint(folder / "c", "run").at("question") == 7);
  BOOST_TEST(numbers_of_checkpoint(folder / "c", 3) == numbers, boost::test_tools::per_element());
  BOOST_TEST(refuses<refusal>([&] { numbers_of_checkpoint(folder / "c", 2); }, {"was edited"}));
}

// The check runs while the file is locked against other processes; if it throws, the older checkpoint stays.
BOOST_AUTO_TEST_CASE(what_is_there_is_seen_under_the_lock) {
  const scratch folder("checkpoint_file_look");
  const std::vector<double> numbers{0.5};
  bool is_locked = false;
  const auto check = [&] {
    is_locked = nysalt::detail::is_locked(folder / "c.next.part");
    if (std::filesystem::exists(folder / "c")) throw refusal("it is there");
  };
  write_checkpoint_file(folder / "c", {{"command", "run"}, {"question", 7}}, numbers, check);
  BOOST_TEST(is_locked);
  BOOST_TEST(refuses<refusal>(
      [&] {
        write_checkpoint_file(folder / "c", {{"command", "run"}, {"question", 8}}, numbers, check);
      },
      {"it is there"}));
  BOOST_TEST(head_of_checkpoint(folder / "c", "run").at("question") == 7);
  BOOST_TEST(folder.files().size() == 1U);
}

// Memory that may not be read (PROT_NONE): the size is refused before any number is read.
BOOST_AUTO_TEST_CASE(what_is_too_large_to_be_read_is_not_written) {
  const scratch folder("checkpoint_file_large");
  constexpr std::size_t count = (std::size_t{1} << 27U) + 1;
  void* nothing =
      mmap(nullptr, count * sizeof(double), PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  BOOST_TEST_REQUIRE(nothing != MAP_FAILED);
  const std::span<const double> numbers(static_cast<const double*>(nothing), count);
  BOOST_TEST(refuses<refusal>(
      [&] {
        write_checkpoint_file(folder / "c", {{"command", "run"}}, numbers);
      },
      {"must hold at most 1024 MB of numbers", "take fewer trajectories"}));
  munmap(nothing, count * sizeof(double));
  const std::string text(std::size_t{1} << 26U, 'a');
  BOOST_TEST(refuses<refusal>(
      [&] {
        write_checkpoint_file(folder / "c", {{"command", text}}, {});
      },
      {"64 MB of text", "leave --checkpoint out"}));
  BOOST_TEST(folder.files().empty());
}
