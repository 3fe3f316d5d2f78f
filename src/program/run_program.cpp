// SPDX-License-Identifier: BSL-1.0
#include "run_program.hpp"

#include <exception>
#include <new>
#include <string>

#include <fmt/format.h>

#include "command_line.hpp"
#include "commands.hpp"
#include "comparison/interruption.hpp"
#include "output.hpp"

namespace nysalt::program {

namespace {

int refused(const std::string& text) {
  complain(text);
  return bad_input;
}

}  // namespace

int exit_code_of(const std::function<int()>& work) {
  try {
    return work();
  } catch (const interrupted&) {
    complain(
        fmt::format("ended by signal {}: the checkpoint is there, and --resume goes on", noted_signal()));
    return 128 + noted_signal();
  } catch (const std::bad_alloc&) {
    return refused(
        "this does not fit into memory: take fewer trajectories, a shorter horizon or a smaller system");
  } catch (const std::exception& problem) {
    return refused(problem.what());
  } catch (...) {  // by a system of the user's own
    return refused("something was thrown that is no std::exception: which it is cannot be told");
  }
}

int run_program(int argc, char** argv) {
  return exit_code_of([&] { return run_command_line(argc, argv); });
}

}  // namespace nysalt::program
