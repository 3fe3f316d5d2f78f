// SPDX-License-Identifier: BSL-1.0
// What ends a process that waits, and a job that is queued again; more of what ends a run from outside is in
// cases/interruption.txt.
#include <boost/test/unit_test.hpp>

#include <filesystem>
#include <fstream>
#include <string>

#include "../support/sanitizers.hpp"
#include "../support/stopping.hpp"

using namespace nysalt::test;

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
  std::filesystem::remove(folder / "out.h5");
  std::filesystem::remove(folder / "out.checkpoint");
  for (const std::string call : {"pwrite:2", "rename:3", "pwrite:5", "fsync:4", "rename:2"}) {
    BOOST_TEST(job(with_fault(call + ":kill")).code == 128 + 9, call);
    BOOST_TEST(!std::filesystem::exists(folder / "out.h5"));
  }
  const auto last = job("");
  BOOST_TEST(last.code == 0, last.err);
  BOOST_TEST((contents(folder / "out.h5") == whole));
  BOOST_TEST(!std::filesystem::exists(folder / "out.h5.part"));
}
