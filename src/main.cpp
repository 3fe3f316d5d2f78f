// SPDX-License-Identifier: BSL-1.0
#include <csignal>
#include <exception>
#include <new>
#include <string>

#include "command_line.hpp"
#include "commands.hpp"
#include "output.hpp"

namespace {

int refused(const std::string& text) {
  nysalt::program::complain(text);
  return nysalt::program::bad_input;
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGPIPE, SIG_IGN);  // print() ends quietly when a reader has seen enough
  try {
    return nysalt::program::run_command_line(argc, argv);
  } catch (const std::bad_alloc&) {
    return refused(
        "this does not fit into memory: take fewer trajectories, a shorter horizon or a smaller system");
  } catch (const std::exception& problem) {
    return refused(problem.what());
  }
}
