// SPDX-License-Identifier: BSL-1.0
// Checkpoints can be read again, files are held by one process at a time, rows are sorted in little memory,
// and what is asked again is compared option by option.
#include <fmt/format.h>
#include <sys/mman.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "../support/refusal.hpp"
#include "../support/sanitizers.hpp"
#include "../support/scratch.hpp"
#include "comparison/journal.hpp"
#include "comparison/origin.hpp"
#include "comparison/refusal.hpp"
#include "nysalt/atomic_file.hpp"
#include "program/output/checkpoint_file.hpp"
#include "program/output/samples.hpp"
#include "program/output/unfinished_file.hpp"

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
  const json another{{"command", "run"}, {"question", 8}};
  BOOST_TEST(refuses<refusal>([&] { write_checkpoint_file(folder / "c", another, numbers, check); },
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
  const json small{{"command", "run"}};
  BOOST_TEST(refuses<refusal>([&] { write_checkpoint_file(folder / "c", small, numbers); },
                              {"must hold at most 1024 MB of numbers", "take fewer trajectories"}));
  munmap(nothing, count * sizeof(double));
  const json large{{"command", std::string(std::size_t{1} << 26U, 'a')}};
  BOOST_TEST(refuses<refusal>([&] { write_checkpoint_file(folder / "c", large, {}); },
                              {"64 MB of text", "leave --checkpoint out"}));
  BOOST_TEST(folder.files().empty());
}

// The lock belongs to an open file: a file that is opened twice in one process is refused as by two
// processes.
BOOST_AUTO_TEST_CASE(a_journal_is_of_one_process) {
  const scratch folder("held_journal");
  const json question{{"seed", 1}};
  std::optional<journal> first(std::in_place, folder / "j", question, false);
  for (const bool resume : {false, true}) {
    BOOST_TEST(refuses<refusal>([&] { journal(folder / "j", question, resume); },
                                {"another run is writing it", "name another output"}));
  }
  first.reset();
  const journal second(folder / "j", question, true);
  BOOST_TEST(second.found() == 0U);
}

BOOST_AUTO_TEST_CASE(the_output_of_an_unfinished_run_is_of_one_process) {
  using enum unfinished_file::origin;
  const scratch folder("held_output");
  std::optional<unfinished_file> first(std::in_place, folder / "out.csv", made);
  first->write("a\n");
  first->put_on_disk();
  first->keep();
  for (const auto from : {left_by_another, begun_anew, made}) {
    BOOST_TEST(refuses<refusal>([&] { unfinished_file(folder / "out.csv", from); },
                                {"another run is writing it", "wait for that run"}));
  }
  const file_sum written = first->written();
  first.reset();
  unfinished_file second(folder / "out.csv", left_by_another);
  BOOST_TEST(second.cut_after(written));
}

// Beside a stable sort in memory, for all sizes of what is held at a time: a row, some, all.
BOOST_AUTO_TEST_CASE(rows_are_sorted_in_any_room) {
  const scratch folder("sorted_rows");
  std::vector<std::pair<std::int64_t, std::string>> rows;
  for (const std::int64_t begin : {0, 0, 0, 4, 4, 0}) {  // in the end those of a run that was prolonged
    for (std::int64_t m = begin; m < begin + 4; ++m) {
      for (std::int64_t n = 0; n < 1 + m % 3; ++n)
        rows.emplace_back(m, fmt::format("{},{}\n", m, rows.size()));
    }
  }
  const auto table_of = [&] {
    std::string text = "trajectory,row\n";
    for (const auto& [trajectory, row] : rows) text += row;
    return text;
  };
  std::ofstream(folder / "o.csv.part") << table_of();
  std::ranges::stable_sort(rows, {}, [](const auto& row) { return row.first; });
  const auto sort = [&](std::int64_t trajectories, const sorting_room& room) {
    put_by_trajectory(folder / "o.csv.part", folder / "o.csv", trajectories, room);
  };
  for (const std::size_t text : {1UL, 20UL, 1000UL}) {
    for (const std::int64_t trajectories : {1, 3, 8, 100}) {
      std::ofstream(folder / "o.csv") << "an older one";
      sort(8, {text, trajectories});
      BOOST_TEST(contents(folder / "o.csv") == table_of());
    }
  }
  const auto is_refused = [&](std::int64_t trajectories, const sorting_room& room, const std::string& why) {
    return refuses<nysalt::detail::write_failure>([&] { sort(trajectories, room); },
                                                  {"cannot write", "o.csv: ", why});
  };
  BOOST_TEST(is_refused(7, {}, "o.csv.part cannot be read again"));  // there is a row of another trajectory
  if (!under_address_sanitizer) {
    constexpr std::int64_t too_many = std::int64_t{1} << 44U;
    BOOST_TEST(is_refused(too_many, {20, too_many}, "no memory is left to sort its rows"));
  }
  BOOST_TEST(contents(folder / "o.csv") == table_of());
  BOOST_TEST(folder.files().size() == 2U);
}

// Of files that this program wrote, an older one, another one, and this one on another machine.
BOOST_AUTO_TEST_CASE(another_origin_is_told) {
  const scratch folder("origins");
  write_checkpoint_file(folder / "c", {{"command", "run"}, {"question", 7}}, {});
  json head = head_of_checkpoint(folder / "c", "run");
  BOOST_TEST(warning_of_origin(head, "c").empty());
  BOOST_TEST(warning_of_origin(json::object(), "c").empty());
  const auto says = [](const json& of, const std::string& text) {
    return warning_of_origin(of, "c").find(text) != std::string::npos;
  };
  head["functions"] = "00000000";
  BOOST_TEST(says(head, "c was written on a machine whose C library rounds exp"));
  head["nysalt"] = "0.0.1";
  BOOST_TEST(says(head, "c was written by nysalt 0.0.1, this is "));
}

BOOST_AUTO_TEST_CASE(parts_of_a_journal_have_an_origin) {
  const scratch folder("origin_of_journal");
  const json question{{"seed", 1}};
  journal(folder / "here", question, true);
  BOOST_TEST(journal(folder / "here", question, true).warning().empty());
  json line = parsed(contents(folder / "here"));
  line["functions"] = "00000000";
  line.erase("checksum");
  line["checksum"] = checksum(line);
  std::ofstream(folder / "there") << line.dump() << '\n';
  BOOST_TEST(journal(folder / "there", question, true).warning().find("another way") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(every_option_that_differs_is_named) {
  const json then{{"step", 0.1}, {"seed", 1}, {"horizon", 5.0}};
  const json now{{"step", 0.2}, {"seed", 2}, {"horizon", 5.0}};
  require_question(then, then, "c");
  require_same_question(then, then, "j");
  BOOST_TEST(refuses<refusal>([&] { require_question(then, now, "c"); }, {"another run (step, seed)"}));
  BOOST_TEST(
      refuses<refusal>([&] { require_same_question(then, now, "j"); }, {"another question (step, seed)"}));
}
