// SPDX-License-Identifier: BSL-1.0
#include "destination.hpp"

#include <string_view>

#include "program/output.hpp"

namespace nysalt::program {

namespace {

std::optional<array_layout> arrays_of(const run_command& command, std::int64_t steps, const json& about) {
  if (!array_layout::is_of(command.output)) return std::nullopt;
  const sampled_shape shape{command.trajectories, steps / command.sample_every + 1, command.observables,
                            command.step, command.sample_every};
  return array_layout(command.output, shape, about);
}

}  // namespace

destination::destination(const run_command& command, std::int64_t steps, bool as_json, const json& question,
                         const json& about)
    : output_(command.output),
      columns_(command.observables.size()),
      arrays_(arrays_of(command, steps, about)) {
  if (!command.checkpoint.empty()) {
    kept_.emplace(command.output, command.checkpoint, question, command.resume, arrays_);
  } else if (arrays_) {
    part_.emplace(command.output);
    try {
      arrays_->lay_out(*part_);
    } catch (...) {
      part_->remove();
      throw;
    }
  } else if (!command.output.empty()) {
    table_.emplace(command.output);
  }
  if (arrays_) {
    if (kept_ && !kept_->is_under_way()) return;
    sink_ = std::make_unique<sample_arrays>(kept_ ? kept_->part() : *part_, *arrays_);
    return;
  }
  samples::sink lines;
  if (kept_) {
    lines = [this](std::string_view text) { kept_->part().write(text); };
  } else if (table_) {
    lines = [this](std::string_view text) { table_->write(text); };
  } else if (!as_json) {
    lines = [](std::string_view text) { print(text); };
  }
  auto rows = std::make_unique<samples>(command.observables, command.step, command.sample_every, lines);
  rows_ = rows.get();
  sink_ = std::move(rows);
}

destination::~destination() {
  if (part_) part_->remove();
}

void destination::begin() {
  if (from().is_new()) sink_->begin();
}

void destination::take(std::int64_t trajectory, const record& segment) {
  sink_->take(trajectory, segment);
  if (!segment.diverged_at) return;
  const diverged_trajectory one{trajectory, *segment.diverged_at};
  kept_ ? kept_->lose(one) : lost_.push_back(one);
}

void destination::reached(const standing& at) {
  if (!kept_) return;
  sink_->flush();
  kept_->reached(at);
}

void destination::commit() {
  if (sink_) sink_->flush();
  if (kept_) kept_->commit();
  if (table_) table_->commit();
  if (!part_) return;
  part_->finish();
  part_.reset();
}

void destination::finish() {
  if (kept_) kept_->finish();
}

first_trajectory destination::read_first(std::int64_t every) const {
  if (arrays_) return read_first_trajectory(output_, *arrays_, every);
  return read_first_trajectory(output_, every, columns_);
}

void destination::describe(json& document) const {
  if (rows_ != nullptr) document["columns"] = rows_->columns();
  if (output_.empty()) {
    document["rows"] = rows_->rows();
  } else {
    document["output"] = output_;
  }
}

}  // namespace nysalt::program
