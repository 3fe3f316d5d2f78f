// SPDX-License-Identifier: BSL-1.0
// A run that can be stopped: its output under way and its checkpoint, which know of each other.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "checkpoint.hpp"
#include "unfinished_file.hpp"

namespace nysalt::program {

class restart {
 public:
  /// Begins the run of a question, or, if it is to resume, goes on where its checkpoint says. Throws refusal
  /// for a checkpoint that is none, not whole or of another run; to resume, if there is none or the output
  /// under way is not what it knows; to begin, if there is one of a run that was stopped.
  restart(const std::filesystem::path& output, const std::filesystem::path& checkpoint, const json& question,
          bool resume);
  /// Of a run that reached nothing, as it was refused after all, nothing stays.
  ~restart();
  restart(const restart&) = delete;
  restart& operator=(const restart&) = delete;

  bool is_finished() const { return its_.finished; }
  /// Whether the output of a finished run is not what the run wrote any more.
  bool was_changed() const;
  const standing& from() const { return its_.at; }
  const std::vector<diverged_trajectory>& lost() const { return its_.lost; }

  /// More of the output.
  void write(std::string_view text);
  void lose(const diverged_trajectory& one) { its_.lost.push_back(one); }
  /// Makes a checkpoint of all that was written.
  void reached(const standing& at);
  /// The output is whole: it takes its name.
  void commit();
  /// Nothing is left to do.
  void finish();

 private:
  void begin();
  void take_up(const json& question);

  std::filesystem::path output_;
  std::filesystem::path file_;
  checkpoint its_;
  bool is_fresh_ = false;                // begun here, and nothing reached
  std::optional<unfinished_file> part_;  // none once the output has its name
};

}  // namespace nysalt::program
