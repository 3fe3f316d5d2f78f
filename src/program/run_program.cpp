// SPDX-License-Identifier: BSL-1.0
#include "run_program.hpp"

#include <exception>
#include <new>
#include <string>

#include <fmt/format.h>

#include "command_line.hpp"
#include "commands.hpp"
#include "comparison/interruption.hpp"
#include "nysalt/detail/write_failure.hpp"
#include "output.hpp"

namespace nysalt::program {

namespace {

int reported(const std::string& text, int code) {
  complain(text);
  return code;
}

}  // namespace

int exit_code_of(const std::function<int()>& work) {
  try {
    return work();
  } catch (const interrupted&) {
    complain(
        fmt::format("cannot finish the run: signal {} ended it; take --resume to go on from the checkpoint",
                    noted_signal()));
    return 128 + noted_signal();
  } catch (const std::bad_alloc&) {
    return reported(
        "the command must fit into memory; take fewer trajectories, a shorter horizon or a smaller system",
        bad_input);
  } catch (const nysalt::detail::write_failure& problem) {
    return reported(problem.what(), not_written);
  } catch (const std::exception& problem) {
    return reported(problem.what(), bad_input);
  } catch (...) {  // by a system of the user's own
    return reported("cannot go on: an exception was thrown that is no std::exception, and has no message",
                    bad_input);
  }
}

int run_program(int argc, char** argv) {
  return exit_code_of([&] { return run_command_line(argc, argv); });
}

}  // namespace nysalt::program
