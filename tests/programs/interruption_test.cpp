// SPDX-License-Identifier: BSL-1.0
// What ends a run from outside: signals, a standard error that cannot be written, kills while files are made.
#include <boost/test/unit_test.hpp>

#include <filesystem>
#include <string>

#include "../support/program.hpp"
#include "../support/sanitizers.hpp"

using namespace nysalt::test;

namespace {

const std::string long_run =
    "run --method verlet --step 0.001 --horizon 1e5 --trajectories 3 --sample-every 100000 ";
const std::string short_run =
    "run --method verlet --step 0.001 --horizon 2000 --trajectories 3 --sample-every 1000 ";

/// The exit code of a command that gets a signal once a file is there.
int code_after(const scratch& folder, const std::string& arguments, const std::string& file,
               const std::string& signal) {
  // A shell that is not interactive has its background jobs ignore SIGINT and SIGQUIT; env puts that right.
  const auto done = shell(folder, "env --default-signal=INT,QUIT \"$nysalt\" " + arguments +
                                      " >/dev/null 2>err & p=$!; for i in $(seq 500); do [ -e " + file +
                                      " ] && break; sleep 0.01; done; sleep 0.1; kill -" + signal +
                                      " $p; wait $p; echo $?");
  return std::stoi(done.out);
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_signal_leaves_nothing_without_a_checkpoint) {
  for (const auto& [signal, number] : {std::pair{"INT", 2},
                                       {"TERM", 15},
                                       {"HUP", 1},
                                       {"USR1", 10},
                                       {"USR2", 12},
                                       {"XCPU", 24},
                                       // Those that seldom come end a process too.
                                       {"QUIT", 3},
                                       {"ALRM", 14},
                                       {"VTALRM", 26},
                                       {"PROF", 27},
                                       {"IO", 29},
                                       {"PWR", 30},
                                       {"16", 16},
                                       {"RTMIN", 34},
                                       {"RTMAX", 64}}) {
    for (const std::string kind : {".csv", ".npy", ".h5"}) {
      const scratch folder("signal");
      BOOST_TEST(code_after(folder, long_run + "--output a" + kind, "a" + kind + ".new.part", signal) ==
                 128 + number);
      std::filesystem::remove(folder / "err");
      BOOST_TEST(folder.files().empty(), signal << " " << kind);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_signal_makes_a_checkpoint_where_one_was_asked_for) {
  const scratch folder("signal_checkpoint");
  const std::string whole =
      "run --method verlet --step 0.001 --horizon 20000 --trajectories 3 --sample-every 1000 ";
  BOOST_TEST(run(folder, whole + "--output whole.csv").code == 0);
  const std::string command = whole + "--output a.csv --checkpoint c --every 1000000000";
  BOOST_TEST(code_after(folder, command, "c", "USR1") == 128 + 10);  // Slurm's --signal=USR1
  BOOST_TEST(contents(folder / "err").find("take --resume to go on from the checkpoint") != std::string::npos,
             contents(folder / "err"));
  BOOST_TEST(contents(folder / "c").find("\"first\":0,\"step\":0,") ==
             std::string::npos);  // not the first one
  BOOST_TEST(run(folder, command + " --resume").code == 0);
  BOOST_TEST((contents(folder / "a.csv") == contents(folder / "whole.csv")));
}

// A gnuplot that takes long: the signal ends it, and what it would have done later is not done.
BOOST_AUTO_TEST_CASE(a_signal_ends_a_child_that_draws) {
  if (under_thread_sanitizer) return;  // which holds signals back while a process waits for a child
  for (const auto& [signal, number] : {std::pair{"INT", 2}, {"TERM", 15}, {"HUP", 1}}) {
    const scratch folder("signal_drawing");
    const auto done =
        shell(folder, R"(printf '#!/bin/sh\ntouch begun\nsleep 1\ntouch ended\n' >gnuplot; chmod +x gnuplot
PATH=$PWD:$PATH env --default-signal=INT "$nysalt" run --method verlet --step 0.01 --horizon 1 --output a.csv --plot \
  >/dev/null 2>&1 & p=$!
for i in $(seq 500); do [ -e begun ] && break; sleep 0.01; done
kill -)" + std::string(signal) +
                          " $p; wait $p; echo $?; sleep 1.5; ls");
    BOOST_TEST(done.out.starts_with(std::to_string(128 + number) + "\n"), done.out);
    BOOST_TEST(done.out.find("begun") != std::string::npos);
    BOOST_TEST(done.out.find("ended") == std::string::npos, signal);
    BOOST_TEST(done.out.find(".svg") == std::string::npos, done.out);
    BOOST_TEST(done.out.find("tmp") == std::string::npos, done.out);
  }
}

BOOST_AUTO_TEST_CASE(a_signal_ends_the_compiler_of_a_plug_in) {
  if (under_thread_sanitizer) return;  // the same
  const scratch folder("signal_compiling");
  const auto done = shell(folder, "cp " NYSALT_SOURCE_DIR R"sh(/examples/plugins/toda.hpp mine.hpp
compilers() { cat /proc/[0-9]*/cmdline 2>/dev/null | tr '\0' ' ' | grep -c '[c]c1plus.*signal_compiling'; }
XDG_CACHE_HOME=$PWD/cache "$nysalt" build mine.hpp >/dev/null 2>&1 & p=$!
for i in $(seq 500); do [ "$(compilers)" = 0 ] || break; sleep 0.01; done
kill -TERM $p; wait $p; echo $?
for i in $(seq 100); do [ "$(compilers)" = 0 ] && break; sleep 0.01; done
compilers; find cache -type f; find . -name '*.so*')sh");
  BOOST_TEST(done.out == "143\n0\n", done.out);
}

// gnuplot gets no name to write to: what lies under the names that it once had stays as it is.
BOOST_AUTO_TEST_CASE(pictures_are_not_drawn_through_links) {
  const scratch folder("picture_links");
  const auto done = shell(folder, R"(echo precious >p; ln -s p a.svg.tmp; ln p a.png.tmp
"$nysalt" run --method verlet --step 0.01 --horizon 1 --output a.csv --plot >/dev/null 2>&1; echo $?; cat p)");
  BOOST_TEST(done.out == "0\nprecious\n", done.out);
}

BOOST_AUTO_TEST_CASE(a_signal_that_is_ignored_stays_so) {
  const scratch folder("signal_ignored");
  const auto done =
      shell(folder, "trap '' HUP; \"$nysalt\" " + short_run +
                        "--output a.csv >/dev/null & p=$!; sleep 0.05; kill -HUP $p; wait $p; echo $?");
  BOOST_TEST(done.out == "0\n");
}

BOOST_AUTO_TEST_CASE(standard_error_that_cannot_be_written_changes_nothing) {
  const std::string unstable = "run --method verlet --step 0.03 --horizon 1 --output a.csv";  // which warns
  for (const std::string to : {"2>&-", "2>/dev/full", "2>&1 >/dev/null | true"}) {
    const scratch folder("no_error");
    const bool is_pipe = to.find('|') != std::string::npos;
    const auto code_of = [&](const std::string& arguments) {
      const std::string command =
          is_pipe ? "{ \"$nysalt\" " + arguments + " >/dev/null; echo $? >code; } 2>&1 | true; cat code"
                  : "\"$nysalt\" " + arguments + " >/dev/null " + to + "; echo $?";
      return std::stoi(shell(folder, command).out);
    };
    BOOST_TEST(code_of("run --method nosuch --step 1 --horizon 1") == 2);
    BOOST_TEST(code_of(unstable) == 0);
    BOOST_TEST(std::filesystem::exists(folder / "a.csv"));
    BOOST_TEST(code_of("learn --step 0.3 --trajectories 4 --effort quick --output s.json") != 134);
    BOOST_TEST(code_of("compare --methods verlet --steps 0.03 --trajectories 16 --output r") == 0);
    BOOST_TEST(std::filesystem::exists(folder / "r/rows.csv"));
  }
}

BOOST_AUTO_TEST_CASE(killed_while_a_file_is_laid_out_it_begins_again) {
  for (const std::string kind : {".npy", ".h5"}) {
    const scratch folder("killed_early");
    const std::string command =
        "run --method verlet --step 0.01 --horizon 20 --trajectories 50 --sample-every 10 "
        "--output a" +
        kind + " --checkpoint c --every 100000";
    BOOST_TEST(run(folder, command).code == 0);
    const std::string whole = contents(folder / ("a" + kind));
    // A file as large as a second takes to write, and a kill meanwhile.
    const std::string large =
        "run --method verlet --step 0.01 --horizon 1e4 --trajectories 100 --sample-every 5 "
        "--output b" +
        kind + " --checkpoint d --every 1000000";
    shell(folder, "\"$nysalt\" " + large +
                      " >/dev/null 2>&1 & p=$!; for i in $(seq 500); do [ -e d ] && break; "
                      "sleep 0.01; done; kill -KILL $p; wait $p");
    BOOST_TEST(std::filesystem::exists(folder / "d"));
    const auto again = run(folder, large);
    BOOST_TEST(again.code == 2);
    BOOST_TEST(again.err.find("take --resume to go on with the run") != std::string::npos, again.err);
    // Of the same state for the small run: its first checkpoint, with nothing laid out.
    const std::string small =
        "run --method verlet --step 0.01 --horizon 20 --trajectories 50 --sample-every 10 "
        "--output e" +
        kind + " --checkpoint f --every 100000";
    shell(folder, "ulimit -f 8; \"$nysalt\" " + small + " 2>/dev/null");  // too large: refused
    BOOST_TEST(!std::filesystem::exists(folder / "f"));
    BOOST_TEST(run(folder, small).code == 0);
    BOOST_TEST((contents(folder / ("e" + kind)) == whole));
  }
}

BOOST_AUTO_TEST_CASE(what_a_dead_run_left_does_not_block_the_next) {
  for (const std::string kind : {".csv", ".npy", ".h5"}) {
    const scratch folder("left");
    shell(folder, "\"$nysalt\" " + long_run + "--output a" + kind +
                      " >/dev/null 2>&1 & p=$!; for i in $(seq 500); do [ -e a" + kind +
                      ".new.part ] && break; sleep 0.01; done; kill -KILL $p; wait $p");
    BOOST_TEST(std::filesystem::exists(folder / ("a" + kind + ".new.part")));
    BOOST_TEST(run(folder, short_run + "--output a" + kind).code == 0);
    BOOST_TEST(!std::filesystem::exists(folder / ("a" + kind + ".new.part")));
  }
}

BOOST_AUTO_TEST_CASE(of_two_runs_into_one_file_the_second_is_refused) {
  for (const std::string kind : {".csv", ".npy", ".h5"}) {
    const scratch folder("two");
    const auto done = shell(folder, "\"$nysalt\" " + long_run + "--output a" + kind +
                                        " >/dev/null 2>&1 & p=$!; for i in $(seq 500); do [ -e a" + kind +
                                        ".new.part ] && break; sleep 0.01; done; \"$nysalt\" " + short_run +
                                        "--output a" + kind + "; echo $?; kill $p; wait $p");
    BOOST_TEST(done.out == "2\n");
    BOOST_TEST(done.err.find("another process writes it") != std::string::npos, done.err);
  }
}

// The name of an unfinished file may be named as an output, and a checkpoint too.
BOOST_AUTO_TEST_CASE(no_result_takes_the_place_of_what_is_under_way) {
  for (const std::string kind : {".csv", ".npy", ".h5"}) {
    const scratch folder("two_names");
    const auto begun = [&](const std::string& more) {
      return "\"$nysalt\" " + long_run + "--output a" + kind + more +
             " >/dev/null 2>err & p=$!; for i in $(seq 500); do [ -e c ] && break; sleep 0.01; done; ";
    };
    const std::string checkpointed = " --checkpoint c --every 100000000";
    for (const std::string& name : {"a" + kind + ".part", std::string("c"), std::string("link")}) {
      const auto done =
          shell(folder, "rm -f a* c link; ln -s a" + kind + ".part link; " + begun(checkpointed) +
                            "\"$nysalt\" " + short_run + "--output " + name +
                            "; echo $?; \"$nysalt\" sample --system pendulum --length 1 --draws 10 "
                            "--output " +
                            name + "; echo $?; \"$nysalt\" export verlet --to c --output " + name +
                            "; echo $?; \"$nysalt\" stability --method verlet --output " + name +
                            "; echo $?; kill -KILL $p; wait $p");
      BOOST_TEST(done.out == "2\n2\n2\n2\n", name << ": " << done.out << done.err);
      const bool is_checkpoint = name == "c";
      BOOST_TEST(done.err.find(is_checkpoint ? "it is a checkpoint of what has not finished"
                                             : "another process writes it") != std::string::npos,
                 done.err);
    }
    // What took the place all the same does not become the result.
    const auto taken =
        shell(folder, "rm -f a* c link; " +
                          std::string("\"$nysalt\" run --method verlet --step 0.001 --horizon 20000 ") +
                          "--trajectories 3 --sample-every 1000 --output a" + kind + checkpointed +
                          " >/dev/null 2>err & p=$!; for i in $(seq 500); do [ -e c ] && break; sleep "
                          "0.01; done; echo other >x; mv x a" +
                          kind + ".part; wait $p; echo $?");
    BOOST_TEST(taken.out == "4\n", taken.out << contents(folder / "err"));
    BOOST_TEST(contents(folder / "err").find("another process removed or replaced") != std::string::npos);
    BOOST_TEST(!std::filesystem::exists(folder / ("a" + kind)));
    // Nor is it removed by a run without a checkpoint.
    const std::string is_begun = kind == ".csv" ? "-e" : "-s";
    const auto kept =
        shell(folder,
              "rm -f a* c; \"$nysalt\" run --method verlet --step 0.001 --horizon 20000 "
              "--trajectories 3 --sample-every 1000 --output a" +
                  kind + " >/dev/null 2>err & p=$!; for i in $(seq 500); do [ " + is_begun + " a" + kind +
                  ".new.part ] && break; sleep 0.01; done; echo other >x; mv x a" + kind +
                  ".new.part; wait $p; echo $?; cat a" + kind + ".new.part");
    BOOST_TEST(kept.out == "4\nother\n", kept.out << contents(folder / "err"));
  }
}

BOOST_AUTO_TEST_CASE(no_result_takes_the_place_of_an_input) {
  const scratch folder("inputs");
  std::ofstream(folder / "o.toml") << "method = \"verlet\"\nstep = 0.01\nhorizon = 1\n";
  const std::string before = contents(folder / "o.toml");
  const auto refused = [&](const std::string& arguments) {
    const auto done = run(folder, arguments);
    BOOST_TEST(done.code == 2, arguments);
    BOOST_TEST(done.err.find("was read as input") != std::string::npos, done.err);
  };
  refused("run --config o.toml --output o.toml");
  refused("run --config ./o.toml --output ../" + (folder / "x").parent_path().filename().string() +
          "/o.toml");
  BOOST_TEST(contents(folder / "o.toml") == before);
  BOOST_TEST(
      run(folder, "learn --system henon_heiles --family bab2 --step 0.3 --effort quick --output s.json")
          .code == 0);
  const std::string scheme = contents(folder / "s.json");
  refused("run --system henon_heiles --method s.json --step 0.3 --horizon 3 --output s.json");
  std::filesystem::rename(folder / "s.json", folder / "manifest.json");  // in place of that of s.json
  refused("run --system henon_heiles --method manifest.json --step 0.3 --horizon 3 --output o.csv");
  BOOST_TEST(contents(folder / "manifest.json") == scheme);
}

BOOST_AUTO_TEST_CASE(links_and_devices) {
  const scratch folder("links");
  std::filesystem::create_symlink("real.csv", folder / "link.csv");
  BOOST_TEST(run(folder, short_run + "--output link.csv").code == 0);
  BOOST_TEST(std::filesystem::is_symlink(folder / "link.csv"));
  BOOST_TEST(contents(folder / "real.csv").starts_with("trajectory,"));
  for (const std::string device : {"/dev/stdout", "/dev/null", "/proc/self/fd/1", "/dev/../dev/stdout"}) {
    const auto done = run(folder, short_run + "--output " + device);
    BOOST_TEST(done.code == 2, device);
    BOOST_TEST(done.err.find("not a regular file") != std::string::npos, done.err);
  }
  // By way of links too; what the standard output leads to keeps its text.
  std::filesystem::create_symlink("/dev/stdout", folder / "out.csv");
  std::filesystem::create_symlink("/dev", folder / "devices");
  std::filesystem::create_symlink("/proc/self", folder / "process");
  for (const std::string name : {"out.csv", "devices/none.csv", "process/none.csv", "process/fd/1"}) {
    const auto done =
        shell(folder, "echo kept >real; \"$nysalt\" " + short_run + "--output " + name + " >>real");
    BOOST_TEST(done.code == 2, name);
    BOOST_TEST(done.err.find("not a regular file") != std::string::npos, done.err);
    BOOST_TEST(contents(folder / "real") == "kept\n");
  }
  // A memory file system below /dev is for files, where there is one.
  shell(folder, "mountpoint -q /dev/shm && d=$(mktemp -d -p /dev/shm) && ln -s \"$d\" memory");
  if (std::filesystem::is_directory(folder / "memory")) {
    const auto done = run(folder, short_run + "--output memory/a.csv");
    BOOST_TEST(done.code == 0, done.err);
    BOOST_TEST(contents(folder / "memory/a.csv").starts_with("trajectory,"));
    shell(folder, "rm -r \"$(readlink memory)\"");
  }
  const auto done = shell(
      folder, "mkfifo c.next.part; \"$nysalt\" " + short_run + "--output a.csv --checkpoint c --every 64");
  BOOST_TEST(done.code == 2);
  BOOST_TEST(done.err.find("c.next.part exists") != std::string::npos, done.err);
  BOOST_TEST(!std::filesystem::exists(folder / "a.csv.part"));
}

BOOST_AUTO_TEST_CASE(files_of_options_that_cannot_be) {
  const scratch folder("options");
  const auto told = [&](const std::string& text, const std::string& words) {
    std::ofstream(folder / "o.toml") << text;
    const auto done = run(folder, "run --method verlet --step 0.01 --horizon 1 --config o.toml");
    BOOST_TEST(done.code == 2, text);
    BOOST_TEST(done.err.find(words) != std::string::npos, done.err);
  };
  for (const std::string value : {"7", "-3", "1e400", "\"yes\"", "[true, false]"})
    told("json = " + value + "\n", "--json must be true or false");
  const auto endless = shell(folder, "head -c 2000000 /dev/zero | \"$nysalt\" run --config /dev/stdin");
  BOOST_TEST(endless.err.find("shorter than a megabyte") != std::string::npos, endless.err);
  BOOST_TEST(run(folder, "run --method verlet --step 0.1 --horizon 1 --trajectories 281474976710657")
                 .err.find("2^48") != std::string::npos);
  const auto cut = run(folder, "run --method '\xd0\xb6\xd0' --step 0.1 --horizon 1");
  BOOST_TEST(cut.err.find("\xd0\xb6?") != std::string::npos, cut.err);
}

BOOST_AUTO_TEST_CASE(names_that_a_shell_or_a_spreadsheet_would_take) {
  const scratch folder("names");
  std::filesystem::create_directory(folder / "-d");
  for (const std::string before : {"", "CDPATH=/tmp "}) {
    const auto done =
        shell(folder,
              before + "\"$nysalt\" run --method verlet --step 0.01 --horizon 1 --output ./-d/a.csv --plot");
    BOOST_TEST(done.code == 0);
    BOOST_TEST(done.err.empty(), done.err);
    BOOST_TEST(contents(folder / "-d/a.svg").find("</svg>") != std::string::npos);
    shell(folder, "rm ./-d/*");
  }
  BOOST_TEST(
      run(folder, "learn --system henon_heiles --family bab2 --step 0.3 --effort quick --output s.json")
          .code == 0);
  std::filesystem::copy_file(folder / "s.json", folder / "=cmd.json");
  const auto done =
      run(folder,
          "compare --system henon_heiles --methods verlet,=cmd.json --steps 0.3 --trajectories 8 --output r");
  BOOST_TEST(done.code == 0, done.err);
  const std::string rows = contents(folder / "r/rows.csv");
  BOOST_TEST(rows.find(",'=cmd.json,") != std::string::npos, rows);
  BOOST_TEST(rows.find(",=cmd") == std::string::npos);
}

BOOST_AUTO_TEST_CASE(what_is_twice_in_a_table_is_refused) {
  const scratch folder("twice");
  std::ofstream(folder / "t.json")
      << R"({"format": "nysalt table", "version": 1, "letters": "BAB", "coefficients": [0.5, 1, 0.5], "coefficients": [0.4, 1, 0.6]})";
  const auto done = run(folder, "run --method t.json --step 0.01 --horizon 1");
  BOOST_TEST(done.code == 2);
  BOOST_TEST(done.err.find("different names, got \"coefficients\" twice") != std::string::npos, done.err);
}

namespace {

/// The script for Slurm of docs/program.md, with the numbers of a run of some seconds.
std::string script_for_slurm() {
  const std::string page = contents(NYSALT_SOURCE_DIR "/docs/program.md");
  const auto begin = page.find("#!/bin/sh\n#SBATCH");
  BOOST_REQUIRE(begin != std::string::npos);
  std::string script = page.substr(begin, page.find("```", begin) - begin);
  const auto put = [&](const std::string& from, const std::string& to) {
    const auto at = script.find(from);
    BOOST_REQUIRE_MESSAGE(at != std::string::npos, from);
    script.replace(at, from.size(), to);
  };
  put("--horizon 1e6", "--horizon 40000");
  put("--trajectories 100000", "--trajectories 100");
  put("--sample-every 10000", "--sample-every 100");
  put("--threads 32", "--threads 1");
  put("--every 1000000", "--every 400000");
  return script;
}

}  // namespace

// A job that is killed is queued again: with a kill while the file is laid out, then after the first
// checkpoint, and then later and later, it ends with the bytes of a run that nothing happened to.
BOOST_AUTO_TEST_CASE(the_script_for_slurm_outlasts_kills) {
  const scratch folder("slurm");
  std::filesystem::create_directory(folder / "bin");
  std::ofstream(folder / "bin/srun") << "#!/bin/sh\nwhile [ \"$1\" != nysalt ]; do shift; done\nshift\n"
                                        "exec \"$nysalt\" \"$@\"\n";
  std::ofstream(folder / "job") << script_for_slurm();
  const std::string job = "chmod +x bin/srun; PATH=$PWD/bin:$PATH; export PATH nysalt; ";
  const auto undisturbed = shell(folder, job + "sh job");
  if (undisturbed.code == 2 && undisturbed.err.find("without HDF5") != std::string::npos) return;
  BOOST_REQUIRE_MESSAGE(undisturbed.code == 0, undisturbed.err);
  const std::string whole = contents(folder / "out.h5");
  for (const char* file : {"out.h5", "out.checkpoint"}) std::filesystem::remove(folder / file);
  // `exec` in the script's last line too, so that a kill reaches the program itself.
  shell(folder, "sed -i 's/^srun/exec srun/' job");
  const auto killed = [&](const std::string& wait) {
    return shell(folder,
                 job + "sh job >/dev/null 2>err & p=$!; " + wait + "; kill -KILL $p; wait $p; echo $?")
        .out;
  };
  const std::string is_there = "for i in $(seq 1000); do [ -e out.h5.part ] && break; sleep 0.005; done";
  BOOST_TEST(killed(is_there) == "137\n");
  BOOST_TEST(!std::filesystem::exists(folder / "out.h5"));
  std::string code;
  int kills = 1;
  for (double seconds = 0.1; code != "0\n"; seconds *= 1.5, ++kills) {
    BOOST_REQUIRE(kills < 40);
    code = killed("sleep " + std::to_string(seconds));
    BOOST_REQUIRE_MESSAGE(code == "137\n" || code == "0\n", code << contents(folder / "err"));
  }
  BOOST_TEST_MESSAGE(kills << " kills");
  BOOST_TEST((contents(folder / "out.h5") == whole));
  BOOST_TEST(!std::filesystem::exists(folder / "out.h5.part"));
}
