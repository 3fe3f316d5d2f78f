// SPDX-License-Identifier: BSL-1.0
// A run that can be stopped: its output under way and its checkpoint, which know of each other.
#pragma once

#include <filesystem>
#include <optional>

#include "array_layout.hpp"
#include "checkpoint.hpp"
#include "unfinished_file.hpp"

namespace nysalt::program {

class restart {
 public:
  /// Begins the run of a question, or, if it is to resume, goes on where its checkpoint says. Throws refusal
  /// for a checkpoint that is none, not whole or of another run; to resume, if there is none or the output
  /// under way is not what it knows; to begin, if there is one of a run that was stopped.
  /// The output is a table that grows, or, where `arrays` are given, one in which all has its place: then
  /// what was written there after the checkpoint is written again, and only the rest must be as it was.
  restart(const std::filesystem::path& output, const std::filesystem::path& checkpoint, const json& question,
          bool resume, std::optional<array_layout> arrays = {});
  /// Of a run that reached nothing, as it was refused after all, nothing stays.
  ~restart();
  restart(const restart&) = delete;
  restart& operator=(const restart&) = delete;

  bool is_finished() const { return state_.finished; }
  /// Whether the output of a finished run is not what the run wrote any more.
  bool was_changed() const;
  const standing& from() const { return state_.at; }
  const std::vector<diverged_trajectory>& lost() const { return state_.lost; }

  /// Whether there is an output under way: not if it has its name already.
  bool is_under_way() const { return part_.has_value(); }
  unfinished_file& part() { return *part_; }
  void lose(const diverged_trajectory& one) { state_.lost.push_back(one); }
  /// Makes a checkpoint of all that was written.
  void reached(const standing& at);
  /// The output is whole: it takes its name.
  void commit();
  /// Nothing is left to do.
  void finish();

 private:
  void begin();
  void take_up(const json& question);
  unfinished_file go_on_with_part() const;
  /// Of the output, be it under way or not.
  std::optional<file_sum> sum_in(const std::filesystem::path& file) const;

  std::filesystem::path output_;
  std::filesystem::path file_;
  std::optional<array_layout> arrays_;
  checkpoint state_;
  bool is_fresh_ = false;                // begun here, and nothing reached
  std::optional<unfinished_file> part_;  // none once the output has its name
};

}  // namespace nysalt::program
