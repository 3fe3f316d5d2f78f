// SPDX-License-Identifier: BSL-1.0
// Output files: whole or not at all, equal for equal runs, and with a manifest of their folder, which records
// how each was made.
#include <boost/test/unit_test.hpp>

#include <regex>
#include <string_view>

#include "../support/program.hpp"

using namespace nysalt::test;
using names = std::set<std::string>;

namespace {

const std::string learn =
    "learn --family nystrom --trajectories 20 --horizon 0.2 --fine-step 0.001 --step 0.02 ";
const std::string run_it = "run --method verlet --step 0.01 --horizon 0.1 --trajectories 3 ";
const std::string compare =
    "compare --methods verlet,bcss2 --steps 0.01,0.02 --trajectories 3 --horizon 0.2 ";

bool has(const std::string& text, std::string_view word) { return text.find(word) != std::string::npos; }

/// Refused in one line, and the folder's files are these.
void refused_and_left(const scratch& folder, const finished& done, const names& left, int code = 2) {
  BOOST_TEST_CONTEXT("said: " << done.err) {
    BOOST_TEST(done.code == code);
    BOOST_TEST(done.err.starts_with("nysalt: "));
    BOOST_TEST(done.err.find('\n') == done.err.size() - 1);
    BOOST_TEST((folder.files() == left));
  }
}

constexpr int not_written = 4;  // an exit code

bool has_full_device() { return std::filesystem::is_character_file("/dev/full"); }

}  // namespace

BOOST_AUTO_TEST_CASE(equal_runs_write_equal_bytes) {
  const scratch folder("equal");
  const scratch other("equal_elsewhere");
  for (const auto& [arguments, file] : {std::pair{learn + "--output scheme.json", "scheme.json"},
                                        std::pair{run_it + "--output out.csv", "out.csv"}}) {
    BOOST_TEST(run(folder, arguments + " --threads 1").code == 0);
    BOOST_TEST(run(other, arguments + " --threads 3").code == 0);
    BOOST_TEST(!contents(folder / file).empty());
    BOOST_TEST(contents(folder / file) == contents(other / file));
    BOOST_TEST(run(other, arguments + " --seed 2").code == 0);  // numbers of its own
    BOOST_TEST(contents(folder / file) != contents(other / file));
  }
  // And those that go to the standard output.
  BOOST_TEST(run(run_it).out == contents(folder / "out.csv"));
}

BOOST_AUTO_TEST_CASE(a_manifest_tells_where_a_file_is_from) {
  const scratch folder("manifest");
  BOOST_REQUIRE(run(folder, run_it + "--seed 7 --observables 'energy' --output 'my out.csv'").code == 0);
  BOOST_TEST((folder.files() == names{"manifest.json", "my out.csv"}));
  const auto manifest = recorded(folder / "my out.csv");
  BOOST_TEST(manifest["file"] == "my out.csv");
  BOOST_TEST(manifest["seed"] == 7);
  BOOST_TEST(manifest["command"].get<std::string>().ends_with(
      "run --method verlet --step 0.01 --horizon 0.1 --trajectories 3 --seed 7 --observables energy --output "
      "'my out.csv'"));
  for (const char* library : {"nysalt", "Eigen", "Boost", "Ceres", "fmt"}) {
    BOOST_TEST(manifest["versions"].contains(library), library);
  }
  BOOST_TEST(!manifest["compiler"].get<std::string>().empty());
  BOOST_TEST(has(manifest["flags"].get<std::string>(), "-ffp-contract=off"));
  const std::regex utc(R"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ)");
  BOOST_TEST(std::regex_match(manifest["time"].get<std::string>(), utc));

  // The command makes the same file again.
  const std::string before = contents(folder / "my out.csv");
  std::filesystem::remove(folder / "my out.csv");
  BOOST_TEST(shell(folder, manifest["command"].get<std::string>()).code == 0);
  BOOST_TEST(contents(folder / "my out.csv") == before);
}

// Each its own file, at the same time.
BOOST_AUTO_TEST_CASE(commands_that_write_into_one_folder_lose_no_entry) {
  const scratch folder("at_once");
  const finished done = shell(folder, "for i in 1 2 3 4 5 6 7 8; do \"$nysalt\" " + run_it +
                                          "--threads 1 --seed $i --output $i.csv & done; wait");
  BOOST_TEST(done.err == "");
  BOOST_TEST(folder.files().size() == 9U);
  for (int i = 1; i <= 8; ++i) BOOST_TEST(recorded(folder / (std::to_string(i) + ".csv"))["seed"] == i);
}

// A disk that is full, for the manifest alone.
BOOST_AUTO_TEST_CASE(a_result_without_its_manifest_is_said_to_be_whole) {
  const scratch folder("manifest_fails");
  for (const char* file : {"a.csv", "c.csv", "d.csv", "e.csv"}) {
    BOOST_TEST_REQUIRE(run(folder, run_it + "--output " + file).code == 0);
  }
  const std::string before = contents(folder / "manifest.json");
  // As many blocks as the result takes, of 512 or 1024 bytes, as the shell has it; the manifest takes more.
  const auto small = std::filesystem::file_size(folder / "a.csv") / 512 + 1;
  BOOST_TEST_REQUIRE(small * 1024 < before.size());
  const finished done =
      shell(folder, "ulimit -f " + std::to_string(small) + "; LLVM_PROFILE_FILE=/dev/null \"$nysalt\" " +
                        run_it + "--output b.csv");
  BOOST_TEST(done.code == not_written);
  BOOST_TEST(has(done.err, "cannot write the manifest of b.csv, which is whole: "), done.err);
  BOOST_TEST(contents(folder / "manifest.json") == before);
  BOOST_TEST(contents(folder / "a.csv") == contents(folder / "b.csv"));
  BOOST_TEST((folder.files() == names{"a.csv", "b.csv", "c.csv", "d.csv", "e.csv", "manifest.json"}));
}

BOOST_AUTO_TEST_CASE(data_hold_nothing_of_machine_or_hour) {
  const scratch folder("data");
  BOOST_REQUIRE(run(folder, learn + "--output scheme.json").code == 0);
  BOOST_REQUIRE(run(folder, run_it + "--output out.csv").code == 0);
  for (const char* file : {"scheme.json", "out.csv"}) {
    const std::string text = contents(folder / file);
    const auto manifest = recorded(folder / file);
    for (const char* key : {"command", "compiler", "flags", "time"}) {
      BOOST_TEST(!has(text, manifest[key].get<std::string>()), file << " holds the " << key);
    }
    BOOST_TEST(!has(text, folder.path().string()));
    BOOST_TEST(!has(text, "seconds"));
  }
}

BOOST_AUTO_TEST_CASE(an_old_file_is_replaced_whole) {
  const scratch folder("replaced");
  const std::string old(1'000'000, 'x');
  std::ofstream(folder / "out.csv") << old;
  std::ofstream(folder / "scheme.json") << old;
  BOOST_REQUIRE(run(folder, run_it + "--output out.csv").code == 0);
  BOOST_REQUIRE(run(folder, learn + "--output scheme.json").code == 0);
  BOOST_TEST(contents(folder / "out.csv") == run(run_it).out);
  BOOST_TEST(nlohmann::json::accept(contents(folder / "manifest.json")));
  BOOST_TEST(nlohmann::json::accept(contents(folder / "scheme.json")));
  BOOST_TEST((folder.files() == names{"manifest.json", "out.csv", "scheme.json"}));
}

BOOST_AUTO_TEST_CASE(what_is_refused_leaves_an_old_file_alone) {
  const scratch folder("left_alone");
  std::ofstream(folder / "out") << "old";
  for (const auto& arguments :
       {run_it + "--observables nosuch --output out", run_it + "--method nosuch --output out",
        run_it + "--system nosuch --output out", learn + "--fix c9=1 --output out",
        learn + "--system pendulum --pairs 3 --output out"}) {
    refused_and_left(folder, run(folder, arguments), {"out"});
    BOOST_TEST(contents(folder / "out") == "old");
  }
  // The fit is not usable: nothing is written either.
  BOOST_TEST(
      run(folder, "learn --family nystrom --trajectories 3 --step 0.1 --fine-step 0.1 --output out").code ==
      3);
  BOOST_TEST(contents(folder / "out") == "old");
  BOOST_TEST((folder.files() == names{"out"}));
}

BOOST_AUTO_TEST_CASE(a_full_disk_is_told_and_nothing_is_left_half) {
  if (!has_full_device()) return;
  const scratch folder("full");
  for (const std::string& arguments :
       {run_it, run_it + "--json", learn, learn + "--json", compare + "--json", compare, std::string("list"),
        std::string("list --json"), std::string("stability --method verlet"), std::string("--help"),
        std::string("--version"), std::string("")}) {
    const finished done = shell(folder, "\"$nysalt\" " + arguments + " >/dev/full");
    BOOST_TEST_CONTEXT(arguments) {
      refused_and_left(folder, done, {}, not_written);
      BOOST_TEST(has(done.err, "standard output"));
    }
  }
  // A file may not grow beyond 512 bytes, but for the line on standard error; counts of lines go elsewhere.
  const auto on_full_disk = [&](const std::string& arguments) {
    return shell(folder,
                 "sh -c 'ulimit -f 1; LLVM_PROFILE_FILE=/dev/null exec \"$nysalt\" " + arguments + "'");
  };
  for (const auto& arguments :
       {learn + "--output out", std::string("run --method verlet --step 1e-4 --horizon 10 --output out")}) {
    std::ofstream(folder / "out") << "old";
    const finished done = on_full_disk(arguments);
    BOOST_TEST(has(done.err, "full"));
    refused_and_left(folder, done, {"out"}, not_written);
    BOOST_TEST(contents(folder / "out") == "old");
  }
}

BOOST_AUTO_TEST_CASE(a_closed_standard_output_is_told) {
  const scratch folder("closed");
  const finished done = shell(folder, "\"$nysalt\" list >&-");
  refused_and_left(folder, done, {}, not_written);
}

// Terminals obey some letters, and a line break would begin a line that is not of the program.
BOOST_AUTO_TEST_CASE(names_are_printed_in_letters) {
  for (const std::string command :
       {"run --method verlet --step 0.02 --horizon 0.1", "learn --trajectories 3 --step 0.02 --horizon 0.1",
        "sample --system pendulum --length 1 --draws 10", "export verlet --to c",
        "compare --methods verlet --steps 0.02 --trajectories 3 --horizon 0.2",
        "stability --method verlet"}) {
    const scratch folder("hostile_name");
    const finished done = shell(folder, "\"$nysalt\" " + command + " --output '\x1b[31m\xff\nx.csv'");
    BOOST_TEST(done.code == 0, command << ": " << done.err);
    BOOST_TEST(has(done.out, "Written:  [31m? x.csv\n"), command << ": " << done.out);
    BOOST_TEST(!has(done.out, "\x1b"), command);
  }
}

// A file that is opened while a stream is closed would get the number of that stream, and what is printed.
BOOST_AUTO_TEST_CASE(what_is_printed_to_a_closed_stream_goes_into_no_file) {
  for (const std::string form : {"csv", "npy", "json"}) {
    // The step is near the limit of stability, for which there is a warning.
    const std::string line =
        "run --system pendulum --method verlet --step 1.9 --horizon 4 --output o." + form;
    const scratch undisturbed("closed");
    const finished whole = run(undisturbed, line);
    BOOST_TEST_REQUIRE(whole.code == 0, whole.err);
    BOOST_TEST_REQUIRE(has(whole.err, "warning"));
    BOOST_TEST_REQUIRE(whole.out != "");
    for (const std::string closed : {"<&-", ">&-", "2>&-", "<&- >&-", ">&- 2>&-", "<&- >&- 2>&-"}) {
      BOOST_TEST_CONTEXT(form << ' ' << closed) {
        const scratch folder("closed");
        const finished done = shell(folder, "\"$nysalt\" " + line + ' ' + closed);
        const bool is_printed = closed.find(" >") == std::string::npos && closed.front() != '>';
        BOOST_TEST(done.code == (is_printed ? 0 : not_written));
        BOOST_TEST(contents(folder / ("o." + form)) == contents(undisturbed / ("o." + form)));
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_reader_who_leaves_is_no_error) {
  const scratch folder("pipe");
  const finished done =
      shell(folder,
            "{ \"$nysalt\" run --method verlet --step 1e-4 --horizon 100 --observables energy; "
            "echo $? >code; } | head -n 2");
  BOOST_TEST(done.out.starts_with("trajectory,step,t,energy\n0,0,0,"));
  BOOST_TEST(std::count(done.out.begin(), done.out.end(), '\n') == 2);
  BOOST_TEST(done.err == "");
  BOOST_TEST(contents(folder / "code") == "0\n");
}

BOOST_AUTO_TEST_CASE(a_comparison_fills_a_folder) {
  const scratch folder("comparison");
  const finished done = run(folder, compare + "--output new/folder");
  BOOST_REQUIRE_MESSAGE(done.code == 0, done.err);
  const auto files_in = [&](const std::string& below) {
    names files;
    for (const auto& entry : std::filesystem::directory_iterator(folder / below)) {
      files.insert(entry.path().filename());
    }
    return files;
  };
  // What a person opens, and little else.
  BOOST_TEST((files_in("new/folder") ==
              names{"manifest.json", "pictures", "report.html", "report.json", "report.md", "rows.csv"}));
  const auto pictures = files_in("new/folder/pictures");
  BOOST_TEST(pictures.contains("manifest.json"));
  for (const char* picture : {"path_stiff_energy_against_evaluations", "path_stiff_energy_against_seconds"}) {
    for (const char* kind : {".svg", ".png", ".gp", ".dat"}) {
      BOOST_TEST(pictures.contains(std::string(picture) + kind), picture << kind);
      BOOST_TEST(recorded(folder / "new/folder/pictures" / (std::string(picture) + kind))["seed"] == 1);
    }
  }
  for (const char* file : {"rows.csv", "report.md", "report.html", "report.json"})
    BOOST_TEST(recorded(folder / "new/folder" / file)["command"].get<std::string>().ends_with("new/folder"),
               file);
  for (const auto& file : pictures) BOOST_TEST(!file.ends_with(".part"), file);

  // Rows as the JSON document tells them, to the last bit.
  const auto rows = json_of(run(compare + "--json"))["rows"];
  std::string csv = contents(folder / "new/folder/rows.csv");
  BOOST_TEST(csv.starts_with(
      "metric,method,step,step_size,evaluations_per_time,seconds_per_time,"
      "seconds_per_time_median,value,standard_error,diverged,reference_error,null_model,floor,"
      "predictable_until,marks,reason,survivors,quantile_5,quantile_25,median,quantile_75,quantile_95,"
      "median_standard_error,deciding,enough_trajectories,stability_margin\n"));
  BOOST_TEST(std::count(csv.begin(), csv.end(), '\n') == 5);
  for (const auto& row : rows) {
    BOOST_TEST(has(csv, row["method"].get<std::string>() + ","));
    BOOST_TEST(has(csv, "," + row["error"].dump() + "," + row["standard_error"].dump() + ",0,"));
  }
  const auto report = nlohmann::json::parse(contents(folder / "new/folder/report.json"));
  BOOST_TEST(report["rows"].size() == rows.size());
  for (const char* page : {"new/folder/report.md", "new/folder/report.html"}) {
    const std::string text = contents(folder / page);
    for (const char* what : {"verlet", "bcss2", "null model", "Best at its cost", "peak memory"}) {
      BOOST_TEST(has(text, what), page << " lacks " << what);
    }
  }
  // The verdict comes first, then pictures, then all rows.
  const std::string markdown = contents(folder / "new/folder/report.md");
  std::size_t at = 0;
  for (const char* next :
       {"\nOnly `bcss2` is ranked", "| evaluations/time, at most |", "\n## ",
        "](pictures/path_stiff_energy_against_evaluations.svg)",
        "](pictures/path_stiff_energy_against_seconds.svg)", "\n## All rows\n", "| standard error |"}) {
    at = markdown.find(next, at);
    BOOST_TEST_REQUIRE(at != std::string::npos, "missing, or too early: " << next);
  }
  const auto& ranking = report["rankings"][0];
  BOOST_TEST(ranking["verdict"].get<std::string>().starts_with("Only bcss2 is ranked"));
  BOOST_TEST(ranking["best_at_costs"].size() >= 2U);  // a row of each step
  BOOST_TEST(ranking["best_at_costs"][0]["best"][0]["method"] == "bcss2");
  BOOST_TEST(ranking["best_at_costs"][0]["next"].is_null());  // Verlet is no better than the null model here
  // The page needs nothing else, and weighs less than 2 MB.
  const std::string page = contents(folder / "new/folder/report.html");
  BOOST_TEST(has(page, "<svg"));
  BOOST_TEST(!has(page, "src="));
  BOOST_TEST(page.size() < 2'000'000U);
}

// What the metrics of laws add: a picture of each step, and the floor of the errors.
BOOST_AUTO_TEST_CASE(a_comparison_of_laws_draws_them) {
  const scratch folder("laws");
  for (const std::string& metric : {std::string("distribution"), std::string("acf")}) {
    const std::string line =
        "compare --system oscillator --omega 1 --friction 1 --temperature 0.5 --steps 0.1,0.2 "
        "--methods baoab,obabo --trajectories 20 --horizon 4 --metric " +
        metric;
    const finished done = run(folder, line + " --output " + metric);
    BOOST_REQUIRE_MESSAGE(done.code == 0, done.err);
    for (const char* step : {"_at_0_1", "_at_0_2"}) {
      const auto picture = folder / metric / "pictures" / (metric + "_energy" + step);
      BOOST_TEST(has(contents(picture.string() + ".svg"), "<svg"));
      BOOST_TEST(contents(picture.string() + ".png").starts_with("\x89PNG"));
      for (const char* curve : {"reference", "baoab", "obabo"})
        BOOST_TEST(has(contents(picture.string() + ".dat"), curve), metric << step << ": " << curve);
    }
    const std::string csv = contents((folder / metric) / "rows.csv");
    const auto report = json_of(run(line + " --json"));
    for (const auto& row : report.at("rows")) BOOST_TEST(has(csv, "," + row["floor"].dump() + ","));
  }
}

BOOST_AUTO_TEST_CASE(a_comparison_that_cannot_be_leaves_no_folder) {
  const scratch folder("no_folder");
  refused_and_left(folder,
                   run(folder,
                       "compare --methods verlet --steps 0.01,0.0105 --fine-step 0.001 --horizon 0.1 "
                       "--trajectories 3 --output new"),
                   {});
}

BOOST_AUTO_TEST_CASE(a_run_is_drawn_beside_its_output) {
  const scratch folder("plot");
  const finished done = run(folder, run_it + "--observables energy,q1 --output out.csv --plot");
  BOOST_REQUIRE_MESSAGE(done.code == 0, done.err);
  BOOST_TEST(folder.files().contains("out.csv"));
  BOOST_TEST(contents(folder / "out.svg").find("<svg") != std::string::npos);
  BOOST_TEST(contents(folder / "out.png").starts_with("\x89PNG"));
  BOOST_TEST(contents(folder / "out.csv") == run(run_it + "--observables energy,q1").out);
}
