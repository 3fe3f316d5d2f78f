// SPDX-License-Identifier: BSL-1.0
#include "run_program.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "../plugin/named_signals.hpp"
#include "commands.hpp"
#include "comparison/interruption.hpp"
#include "comparison/spelling.hpp"
#include "mpi_session.hpp"
#include "nysalt/atomic_file.hpp"
#include "output.hpp"

namespace nysalt::program {

namespace {

std::atomic<bool> is_reported = false;  // an error, by the main thread or by the terminate handler
std::atomic<bool> is_terminating = false;

/// Where one thread has reported the error, another only waits for the end of the process.
[[noreturn]] void wait_for_end() {
  constexpr int most_milliseconds = 10'000;
  ::poll(nullptr, 0, most_milliseconds);
  ::_exit(bad_input);
}

int reported(const std::string& text, int code) {
  if (is_reported.exchange(true) && is_terminating) wait_for_end();
  complain(text);
  return code;
}

/// Opens something in the place of each standard stream that is closed, which cannot be read nor written. A
/// result would be opened in that place otherwise, and what is printed would go into it.
void occupy_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(stream, F_GETFD) == -1) open("/", O_RDONLY | O_DIRECTORY);  // at the least number that is free
  }
}

std::terminate_handler previous_handler = nullptr;

/// Terminate handler for a thread of oneTBB that cannot start another one: nothing catches the exception
/// there. The library has tried the threads before, but other processes may have started theirs since.
[[noreturn]] void end_for_want_of_threads() {
  is_terminating = true;
  if (is_reported.exchange(true)) wait_for_end();
  try {
    if (const auto thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::runtime_error& problem) {
    if (std::string_view(problem.what()).starts_with("pthread_create")) {  // what oneTBB says
      try {
        complain(fmt::format("cannot start a thread: {}; take fewer --threads", problem.what()));
      } catch (...) {  // without memory; an exception from here would call this handler again, which waits
      }
      nysalt::detail::remove_unfinished_files();
      ::_exit(bad_input);
    }
  } catch (...) {  // left to the previous handler
  }
  previous_handler();
  std::abort();
}

}  // namespace

int exit_code_of(command_line run, int argc, char** argv) {
  spell_as_options();
  try {
    return run(argc, argv);
  } catch (const interrupted& by) {
    complain(fmt::format("cannot finish the run: signal {} ended it; take --resume to go on", by.signal()));
    return 128 + by.signal();
  } catch (const std::bad_alloc&) {
    return reported(
        "the command must fit into memory; take fewer trajectories, a shorter horizon or a smaller system",
        bad_input);
  } catch (const nysalt::detail::write_failure& problem) {
    return reported(problem.what(), not_written);
  } catch (const std::exception& problem) {
    const std::string text = problem.what();
    return reported(text.empty() ? "cannot go on: an exception without a message was thrown" : text,
                    bad_input);
  } catch (...) {  // by a system of the user's own
    return reported("cannot go on: an exception was thrown that is no std::exception, and has no message",
                    bad_input);
  }
}

int run_program(command_line run, int argc, char** argv) {
  occupy_closed_streams();
  std::signal(SIGCHLD, SIG_DFL);  // where it is ignored no child can be waited for
  std::signal(SIGPIPE, SIG_IGN);  // print() ends quietly when a reader has seen enough
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is reported like a full disk
  allow_named_signals();
  previous_handler = std::set_terminate(end_for_want_of_threads);
  try {
    const mpi_session ranks(argc, argv);
    handle_signals();  // after MPI, which may have handlers of its own
    const int code = exit_code_of(run, argc, argv);
    allow_exit();
    return ranks.leave(code);
  } catch (const std::exception& problem) {
    complain(problem.what());
  } catch (...) {
    complain("cannot go on: something was thrown that is no std::exception");
  }
  return bad_input;
}

}  // namespace nysalt::program
