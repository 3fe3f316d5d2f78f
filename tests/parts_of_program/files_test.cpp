// SPDX-License-Identifier: BSL-1.0
// Work files can be read again, files are held by one process at a time, rows are sorted in little memory,
// and what is asked again is compared option by option; what is kept of an answer is all of it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "../support/refusal.hpp"
#include "../support/sanitizers.hpp"
#include "../support/scratch.hpp"
#include "comparison/kept_answers.hpp"
#include "comparison/origin.hpp"
#include "comparison/refusal.hpp"
#include "comparison/work_file.hpp"
#include "nysalt/atomic_file.hpp"
#include "program/output/samples.hpp"
#include "program/output/unfinished_file.hpp"

using namespace nysalt;
using namespace nysalt::program;
using namespace nysalt::test;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
const json question{{"seed", 1}};

double part(work_file& work, const std::string& name, double found) {
  return once<double>(&work, name, [&] { return found; });
}

}  // namespace

BOOST_AUTO_TEST_CASE(what_is_kept_is_read_again) {
  const scratch folder("work_file");
  const std::vector<double> numbers{0.5, -1.0, 3.0};
  {
    work_file work(folder / "w", question, false);
    BOOST_TEST((part(work, "a", 0.1) == 0.1));
    BOOST_TEST((part(work, "a", 0.2) == 0.1));
    work.replace("state", 7, {1.0});
    work.replace("state", 8, numbers);
    BOOST_TEST((part(work, "b", infinite) == infinite));
  }
  work_file again(folder / "w", question, true);
  BOOST_TEST(again.found() == 4U);  // and how many numbers there are
  BOOST_TEST((part(again, "a", 0.2) == 0.1));
  BOOST_TEST((part(again, "b", 1.0) == infinite));
  BOOST_TEST((again.result_of("state") == 8));
  BOOST_TEST(again.numbers() == numbers, boost::test_tools::per_element());
  BOOST_TEST(refuses<refusal>([&] { again.result_of("c"); }, {"the part 'c' is not whole"}));
  again.remove();
  BOOST_TEST(folder.files().empty());
}

// Finished parts are not overwritten, and of what is refused the file stays as it is; without parts no file
// stays.
BOOST_AUTO_TEST_CASE(what_cannot_be_gone_on_with_is_left_alone) {
  const scratch folder("work_file_refused");
  const auto begins = [&](const json& asked, bool resume) { work_file(folder / "w", asked, resume); };
  begins(question, false);
  BOOST_TEST(folder.files().empty());
  {
    work_file work(folder / "w", question, false);
    part(work, "a", 1.0);
    work.replace("state", 7, {1.0, 2.0});
  }
  const std::string sound = contents(folder / "w");
  BOOST_TEST(
      refuses<refusal>([&] { begins(question, false); }, {"3 finished parts", "resume it, or remove"}));
  BOOST_TEST(refuses<refusal>([&] { begins({{"seed", 2}}, true); }, {"another question (seed)"}));
  BOOST_TEST(contents(folder / "w") == sound);
  for (std::size_t at = 0; at < sound.size(); at += 7) {
    std::string edited = sound;
    edited[at] = static_cast<char>(edited[at] ^ 1);
    std::ofstream(folder / "w", std::ios::binary) << edited;
    BOOST_TEST(refuses<refusal>([&] { begins(question, true); }, {"cannot resume from", "remove"}));
    BOOST_TEST(contents(folder / "w") == edited);
    if (at > 0 && sound[at - 1] == '\n') continue;  // whole lines are
    std::ofstream(folder / "w", std::ios::binary) << sound.substr(0, at);
    BOOST_TEST(refuses<refusal>([&] { begins(question, true); }, {"cannot resume from", "remove"}));
  }
}

// The lock belongs to an open file: a file that is opened twice in one process is refused as by two
// processes.
BOOST_AUTO_TEST_CASE(a_work_file_is_of_one_process) {
  const scratch folder("held_work");
  std::optional<work_file> first(std::in_place, folder / "w", question, false);
  const auto begins = [&](bool resume) { work_file(folder / "w", question, resume); };
  for (const bool has_parts : {false, true}) {
    for (const bool resume : {false, true}) {
      BOOST_TEST(refuses<nysalt::detail::file_in_use>([&] { begins(resume); },
                                                      {"another process writes it", "name another"}));
    }
    if (!has_parts) part(*first, "a", 1.0);
  }
  first.reset();
  begins(true);
}

namespace {

template <std::size_t... I>
constexpr auto members(std::index_sequence<I...>)
    -> std::tuple<std::conditional_t<(I < 0), int, double>&...>*;

/// Whether a list of members that lacks one is seen, and the whole one is not.
template <class T>
constexpr bool counts_members() {
  constexpr std::size_t all = std::tuple_size_v<decltype(members_of(std::declval<T&>()))>;
  return has_more_members<T>(static_cast<decltype(members(std::make_index_sequence<all - 1>()))>(nullptr)) &&
         !has_more_members<T>(static_cast<decltype(members(std::make_index_sequence<all>()))>(nullptr));
}
static_assert(counts_members<fit_summary>() && counts_members<judgement>() &&
              counts_members<method_error>() && counts_members<trajectory_errors_result>() &&
              counts_members<acceptance_step>());

}  // namespace

// Values of each kind.
BOOST_AUTO_TEST_CASE(an_answer_is_kept_to_the_bit) {
  kept_fit fit{.fit = {}, .coefficients = {0.1, -0.0, -infinite}, .energies = energy_range{0.1, infinite}};
  fit.fit.family = "bab3";
  fit.fit.seed = ~std::uint64_t{0};
  fit.fit.parameters = {{"b1", 1.0 / 3.0, std::nan(""), true}};
  fit.fit.flat_directions = {{1.0}, {}};
  fit.fit.judgement.first_lost = diverged_trajectory{3, 4};
  fit.fit.judgement.verdict = step_verdict::unstable;
  fit.fit.gaps = {{0.5, 1.5}};
  const std::string text = written(fit).dump();
  kept_fit again;
  read_back(json::parse(text), again);
  BOOST_TEST(written(again).dump() == text);
  BOOST_TEST((again.fit.parameters.at(0).value == 1.0 / 3.0 &&
              std::isnan(again.fit.parameters.at(0).standard_error)));
  BOOST_TEST((std::signbit(again.coefficients.at(1)) && again.coefficients.at(2) == -infinite));
  BOOST_TEST((again.fit.judgement.first_lost->step == 4 && !again.fit.judgement.margin));
  BOOST_CHECK_THROW(read_back(json::parse("[[]]"), again), std::exception);
}

BOOST_AUTO_TEST_CASE(the_output_of_an_unfinished_run_is_of_one_process) {
  using enum unfinished_file::origin;
  const scratch folder("held_output");
  std::optional<unfinished_file> first(std::in_place, folder / "out.csv", made);
  first->write("a\n");
  first->put_on_disk();
  first->keep();
  for (const auto from : {left_by_another, made}) {
    BOOST_TEST(refuses<refusal>([&] { unfinished_file(folder / "out.csv", from); },
                                {"another process writes it", "wait for that"}));
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
  work_file(folder / "none", question, true);
  work_file(folder / "w", question, true).replace("state", 7, {});
  const auto warning = [&] { return work_file(folder / "w", question, true).warning(); };
  const auto edit = [&](const char* member, const char* value) {
    const std::string text = contents(folder / "w");
    json line = parsed(text.substr(0, text.find('\n')));
    line[member] = value;
    line.erase("checksum");
    line["checksum"] = checksum(line);
    std::ofstream(folder / "w") << line.dump() << text.substr(text.find('\n'));
  };
  BOOST_TEST(warning().empty());
  BOOST_TEST(warning_of_origin(json::object(), "w").empty());
  edit("functions", "00000000");
  BOOST_TEST(warning().find("was written on a machine whose C library rounds exp") != std::string::npos);
  edit("nysalt", "0.0.1");
  BOOST_TEST(warning().find("was written by nysalt 0.0.1, this is ") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(every_option_that_differs_is_named) {
  const json then{{"step", 0.1}, {"seed", 1}, {"horizon", 5.0}};
  const json now{{"step", 0.2}, {"seed", 2}, {"horizon", 5.0}};
  require_same_question(then, then, "j");
  BOOST_TEST(
      refuses<refusal>([&] { require_same_question(then, now, "j"); }, {"another question (step, seed)"}));
}
