// SPDX-License-Identifier: BSL-1.0
#include "../commands.hpp"
#include "../fitted_family.hpp"
#include "../output.hpp"
#include "comparison/all_ranks.hpp"
#include "comparison/refusal.hpp"
#include "nysalt/communicator.hpp"
#include "report/result_file.hpp"

namespace nysalt::program {

int learn(const learn_command& command, const common_settings& common) {
  fitted_family training(command, common);
  on_first(all_ranks(), [&] {
    if (!command.output.empty()) require_result(command.output);
  });
  warn_of_threads(common);
  const auto work = begin_work(command.output, question_of(training.system(), common), command.resume);
  tell_of_parts(work.get());
  training.learn(work.get());

  const auto& learned = training.learned();
  const learned_scheme* bad = training.unusable();
  const bool keep = !command.output.empty() && (bad == nullptr || common.force);
  const auto write = [&] {
    on_first(all_ranks(), [&] {
      if (keep) write_document(command.output, training.scheme(), common);
      if (work) work->remove();
    });
  };
  write_and_print(write, [&](bool written) {
    if (common.json) {
      json result = training.document();
      result["output"] = keep && written ? json(command.output) : json(nullptr);
      print(text_of(result));
      return;
    }
    for (std::size_t k = 0; k < learned.size(); ++k) {
      const learned_scheme& one = learned[k];
      const bool in_full = command.step || !written;  // with all digits
      print(in_full ? one.fit.full() : one.fit.brief() + "\n");
      if (const auto& rival = training.losing_fewest()[k])
        print(fmt::format("  {:<22}{}\n", "loses fewest", in_words(*rival)));
      if (one.course && command.step) print(fmt::format("  {:<22}{}\n", "enough", one.course->report()));
    }
    if (!training.purpose().empty()) print(fmt::format("  {:<22}{}\n", "for", training.purpose()));
    if (training.where())
      print(fmt::format("  {:<22}{}: {}\n", "letters O", to_string(*training.where()),
                        learned.front().method.letters().letters()));
    if (keep && written) print(line_of_written(command.output));
  });
  if (!common.json) {
    for (const auto& text : training.warnings()) warn(text);
  }
  if (bad == nullptr) return done;
  const bool withheld = !command.output.empty() && !keep;
  warn(message("the fit at step {} is not usable: {}{}", bad->fit.step, bad->fit.reason,
               withheld ? "; the scheme file was not written (--force writes it)" : ""));
  return no_result;
}

}  // namespace nysalt::program
