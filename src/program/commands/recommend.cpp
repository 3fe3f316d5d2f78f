// SPDX-License-Identifier: BSL-1.0
#include <filesystem>
#include <string>

#include "comparison/recommendation.hpp"
#include "comparison/sampling_choice.hpp"
#include "program/systems.hpp"
#include "report/result_file.hpp"

#include "../commands.hpp"
#include "../output.hpp"
#include "comparison/all_ranks.hpp"
#include "comparison/interruption.hpp"
#include "comparison/purpose.hpp"
#include "nysalt/communicator.hpp"

namespace nysalt::program {

namespace {

/// Does the work, prints what was found, and writes the method to take. The best so far is in the output from
/// the moment on that it is known, and stays there if a signal ends the work, which --resume goes on with.
int print_result(auto& all, prepared_problem& system, const recommend_command& command,
                 const common_settings& common) {
  const std::string& output = command.output;
  if (!output.empty()) on_first(all_ranks(), [&] { require_result(output); });
  warn_of_threads(common);
  const auto work = begin_work(output, question_of(system, common), command.resume);
  tell_of_parts(work.get());
  system.keep_answers_in(work.get());
  const std::string file = of_letters(output);
  last_words said(
      output.empty()
          ? std::string("no method was accepted so far")
          : fmt::format("no method was accepted so far, and {} was not written; take --resume to go on",
                        file));
  const auto write_text = [&](const std::string& text) {
    on_first(all_ranks(), [&] { write_document(output, json::parse(text), common); });
  };
  bool is_kept = false;
  all.learn_and_rank([&](const chosen_method& best) {
    const std::string which = fmt::format("the best so far, {} at step {:.12g}", best.name, best.step);
    if (output.empty()) return said.set(which + ", was not written; take --output FILE to keep it");
    try {
      said.set(fmt::format("{} has {}; take --resume to go on", file, which), [&] { write_text(best.text); });
      is_kept = true;
    } catch (const std::exception&) {  // it is written again at the end, which says why it cannot be
    }
  });
  const auto chosen = all.chosen();
  const bool writes = chosen && !output.empty();
  const auto write = [&] {
    if (writes) write_text(chosen->text);
    if (!chosen && is_kept)
      said.set({}, [&] { on_first(all_ranks(), [&] { std::filesystem::remove(output); }); });
    if (work) work->remove();
  };
  write_and_print(write, [&](bool written) {
    if (common.json) {
      json result = all.document();
      result["output"] = writes && written ? json(output) : json(nullptr);
      print(text_of(result));
      return;
    }
    print(all.readable(form_of(common)));
    for (const auto& text : all.warnings()) warn(text);
    if (writes && written) print(line_of_written(output));
  });
  if (chosen) return done;
  warn(output.empty() ? "no method is accepted"
                      : fmt::format("no method is accepted, and {} was not written", file));
  return no_result;
}

}  // namespace

int recommend(const recommend_command& command, const common_settings& common) {
  auto made = make_system(command.system);
  prepared_problem& system = *made;
  if (command.learning.purpose == for_sampling) {
    sampling_choice all(std::move(made), command.sampling, common);
    return print_result(all, system, command, common);
  }
  recommendation all(std::move(made), command, common);
  return print_result(all, system, command, common);
}

}  // namespace nysalt::program
