// SPDX-License-Identifier: BSL-1.0
// What ends a run from outside, and what else is at its files meanwhile: signals and kills come before a
// chosen call, and other commands run while it is stopped there. Also names and streams that it must not
// harm: the table.
#include <boost/test/unit_test.hpp>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "../support/sanitizers.hpp"
#include "../support/stopping.hpp"
#include "../support/table.hpp"

using namespace nysalt::test;

namespace {

const std::string short_run =
    "run --method verlet --step 0.001 --horizon 2 --trajectories 3 --sample-every 100 ";

/// Kinds of outputs, and the call by which a run without a checkpoint first writes one.
struct kind {
  std::string ending;
  std::string call;
};
std::vector<kind> kinds() {
  std::vector<kind> all{{".csv", "write"}, {".npy", "pwrite"}};
  if (run(short_run + "--output a.h5").err.find("built without HDF5") == std::string::npos)
    all.push_back({".h5", "pwrite"});
  return all;
}

/// Lines of a shell that start `nysalt arguments`, whose errors go to the file err, and wait until it stops
/// itself before a call.
std::string stopped_at(const std::string& call, const std::string& arguments) {
  return with_fault(call + ":signal_19") + "\"$nysalt\" " + arguments +
         " >/dev/null 2>err & p=$!; for i in $(seq 2000); do grep -q 'State:.T' /proc/$p/status && break; "
         "sleep 0.01; "
         "done; ";
}
const std::string goes_on = "kill -CONT $p; wait $p; echo $?";

}  // namespace

BOOST_AUTO_TEST_CASE(rows_of_interruption) { run_table("interruption"); }

BOOST_AUTO_TEST_CASE(a_signal_leaves_nothing_without_a_checkpoint) {
  // SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGUSR2, SIGXCPU; and those that seldom come: SIGQUIT, SIGALRM,
  // SIGVTALRM, SIGPROF, SIGIO, SIGPWR, SIGSTKFLT, SIGRTMIN and SIGRTMAX end a process too.
  for (const int signal : {2, 15, 1, 10, 12, 24, 3, 14, 26, 27, 29, 30, 16, 34, 64}) {
    for (const auto& [ending, call] : kinds()) {
      const scratch folder("signal");
      const auto done =
          shell(folder, with_fault(call + ":1:signal_" + std::to_string(signal)) + "\"$nysalt\" " +
                            short_run + "--output a" + ending + " >/dev/null 2>&1; echo $?");
      BOOST_TEST(done.out == std::to_string(128 + signal) + "\n", ending << ": " << done.out);
      BOOST_TEST(folder.files().empty(), signal << " " << ending);
    }
  }
  const scratch folder("signal_ignored");  // stays ignored
  BOOST_TEST(shell(folder, "trap '' HUP; " + with_fault("write:1:signal_1") + "\"$nysalt\" " + short_run +
                               "--output a.csv >/dev/null")
                 .code == 0);
}

// A gnuplot that takes long: the signal ends it, and what it would have done later is not done.
BOOST_AUTO_TEST_CASE(a_signal_ends_a_child_that_draws) {
  if (under_thread_sanitizer) return;  // which holds signals back while a process waits for a child
  for (const auto& [signal, number] : {std::pair{"INT", 2}, {"TERM", 15}, {"HUP", 1}}) {
    const scratch folder("signal_drawing");
    // A shell that is not interactive has its background jobs ignore SIGINT; env puts that right.
    const auto done = shell(folder, R"(cat >gnuplot <<'end'
#!/bin/sh
echo $$ >pid; touch begun
while [ ! -e go ]; do sleep 0.02; done
touch ended
end
chmod +x gnuplot
PATH=$PWD:$PATH env --default-signal=INT "$nysalt" run --method verlet --step 0.01 --horizon 1 --output a.csv --plot \
  >/dev/null 2>&1 & p=$!
for i in $(seq 500); do [ -e begun ] && break; sleep 0.01; done
kill -)" + std::string(signal) + R"( $p; wait $p; echo $?; touch go
for i in $(seq 500); do kill -0 $(cat pid) || break; sleep 0.01; done; ls)");
    BOOST_TEST(done.out.starts_with(std::to_string(128 + number) + "\n"), done.out);
    BOOST_TEST(done.out.find("begun") != std::string::npos);
    BOOST_TEST(done.out.find("ended") == std::string::npos, signal);
    BOOST_TEST(done.out.find(".svg") == std::string::npos, done.out);
    BOOST_TEST(done.out.find("tmp") == std::string::npos, done.out);
  }
}

BOOST_AUTO_TEST_CASE(what_a_dead_run_left_does_not_block_the_next) {
  for (const auto& [ending, call] : kinds()) {
    const scratch folder("left");
    const std::string part = "a" + ending + ".new.part";
    BOOST_TEST(is_killed_at(folder, call + ":1", short_run + "--output a" + ending));
    BOOST_TEST(std::filesystem::exists(folder / part));
    BOOST_TEST(run(folder, short_run + "--output a" + ending).code == 0);
    BOOST_TEST(!std::filesystem::exists(folder / part));
  }
}

BOOST_AUTO_TEST_CASE(of_two_runs_into_one_file_the_second_is_refused) {
  for (const auto& [ending, call] : kinds()) {
    const scratch folder("two");
    const std::string line = short_run + "--output a" + ending;
    const auto done =
        shell(folder, stopped_at(call + ":1", line) + "\"$nysalt\" " + line + "; echo $?; " + goes_on);
    BOOST_TEST(done.out == "2\n0\n", done.out);
    BOOST_TEST(done.err.find("another process writes it") != std::string::npos, done.err);
  }
}

// The name of an unfinished file may be named as an output, and a checkpoint too.
BOOST_AUTO_TEST_CASE(no_result_takes_the_place_of_what_is_under_way) {
  for (const auto& [ending, call] : kinds()) {
    const scratch folder("two_names");
    const std::string output = "a" + ending;
    const std::string line = short_run + "--output " + output;
    const std::string checkpointed = line + " --checkpoint c --every 500";
    const std::string others = "for name in " + output +
                               ".part c link; do for line in 'run --method verlet --step 0.001 --horizon 2' "
                               "'sample --system pendulum --length 1 --draws 10' 'export verlet --to c' "
                               "'stability --method verlet'; do "
                               "\"$nysalt\" $line --output $name >/dev/null; echo $?; done; done; ";
    const auto done = shell(
        folder, "ln -s " + output + ".part link; " + stopped_at("rename:3", checkpointed) + others + goes_on);
    std::string codes;
    for (int i = 0; i < 12; ++i) codes += "2\n";
    BOOST_TEST(done.out == codes + "0\n", done.out << done.err);
    BOOST_TEST(done.err.find("it is a checkpoint of what has not finished") != std::string::npos, done.err);
    BOOST_TEST(done.err.find("another process writes it") != std::string::npos, done.err);
    // What took the place all the same does not become the result, nor is it removed by a run without a
    // checkpoint.
    for (const auto& [begun, part] : {std::pair{stopped_at("rename:3", checkpointed), output + ".part"},
                                      {stopped_at(call + ":1", line), output + ".new.part"}}) {
      const auto taken = shell(folder, "rm -f a* c link; " + begun + "echo other >x; mv x " + part + "; " +
                                           goes_on + "; cat " + part);
      BOOST_TEST(taken.out == "4\nother\n", taken.out << contents(folder / "err"));
      BOOST_TEST(contents(folder / "err").find("another process removed or replaced") != std::string::npos);
      BOOST_TEST(!std::filesystem::exists(folder / output));
    }
  }
}

// The script for Slurm of docs/program.md, with the numbers of a short run. A job that is killed is queued
// again: killed while the file is laid out, then at later and later calls, it ends with the bytes of a run
// that nothing happened to.
BOOST_AUTO_TEST_CASE(the_script_for_slurm_outlasts_kills) {
  const std::string page = contents(NYSALT_SOURCE_DIR "/docs/program.md");
  const auto begin = page.find("#!/bin/sh\n#SBATCH");
  BOOST_REQUIRE(begin != std::string::npos);
  std::string script = page.substr(begin, page.find("```", begin) - begin);
  for (const auto& [from, to] : {std::pair{"--horizon 1e6", "--horizon 400"},
                                 {"--trajectories 100000", "--trajectories 10"},
                                 {"--sample-every 10000", "--sample-every 100"},
                                 {"--threads 32", "--threads 1"},
                                 {"--every 1000000", "--every 4000"}}) {
    const auto at = script.find(from);
    BOOST_REQUIRE_MESSAGE(at != std::string::npos, from);
    script.replace(at, std::string(from).size(), to);
  }
  const scratch folder("slurm");
  std::ofstream(folder / "srun")
      << "#!/bin/sh\nwhile [ \"$1\" != nysalt ]; do shift; done\nshift\nexec \"$nysalt\" \"$@\"\n";
  std::ofstream(folder / "job") << script;
  const auto job = [&](const std::string& before) {
    return shell(folder, "chmod +x srun; PATH=$PWD:$PATH; export nysalt; " + before + "sh job >/dev/null");
  };
  const auto undisturbed = job("");
  if (undisturbed.code == 2 && undisturbed.err.find("without HDF5") != std::string::npos) return;
  BOOST_REQUIRE_MESSAGE(undisturbed.code == 0, undisturbed.err);
  const std::string whole = contents(folder / "out.h5");
  for (const char* file : {"out.h5", "out.checkpoint"}) std::filesystem::remove(folder / file);
  for (const std::string call : {"pwrite:2", "rename:3", "pwrite:5", "fsync:4", "rename:2"}) {
    BOOST_TEST(job(with_fault(call + ":kill")).code == 128 + 9, call);
    BOOST_TEST(!std::filesystem::exists(folder / "out.h5"));
  }
  const auto last = job("");
  BOOST_TEST(last.code == 0, last.err);
  BOOST_TEST((contents(folder / "out.h5") == whole));
  BOOST_TEST(!std::filesystem::exists(folder / "out.h5.part"));
}
