// SPDX-License-Identifier: BSL-1.0
#include "given_starts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "comparison/number.hpp"
#include "comparison/observables.hpp"
#include "comparison/refusal.hpp"
#include "csv_file.hpp"
#include "nysalt/core/fingerprint.hpp"
#include "nysalt/ensembles/distributions.hpp"
#include "output/written_arrays.hpp"

namespace nysalt::program {

namespace {

/// A coordinate, or the momentum of one.
struct place {
  bool is_momentum;
  Eigen::Index index;
};

/// The place of a name: of the coordinates, of q1, q2, ..., or of a momentum.
std::optional<place> place_of(std::string_view name, const std::vector<std::string>& coordinates,
                              Eigen::Index count) {
  const auto named = [&](std::string_view of) -> Eigen::Index {
    return std::ranges::find(coordinates, of) - coordinates.begin();
  };
  const Eigen::Index known = std::ssize(coordinates);
  if (const auto i = named(name); i < known) return place{false, i};
  if (const auto i = index_after(name, "q", count)) return place{false, i - 1};
  if (const auto i = index_after(name, "p", count)) return place{true, i - 1};
  if (!name.starts_with('p')) return std::nullopt;
  if (const auto i = named(name.substr(1)); i < known) return place{true, i};
  return std::nullopt;
}

/// "q1, p1, ..., also x, px, ..."
std::string names_of_places(const std::vector<std::string>& coordinates, Eigen::Index count) {
  const std::string last = count == 1 ? "" : fmt::format(" to q{0}, p{0}", count);
  if (coordinates.empty()) return "q1, p1" + last;
  return fmt::format("{0}, p{0}{1}, also q1, p1{2}", coordinates.front(),
                     count == 1 ? "" : fmt::format(" to {0}, p{0}", coordinates.back()), last);
}

std::string_view without_blanks(std::string_view text) {
  constexpr std::string_view blanks = " \t\n";
  const auto first = std::min(text.find_first_not_of(blanks), text.size());
  text.remove_prefix(first);
  return text.substr(0, text.find_last_not_of(blanks) + 1);
}

/// States of a list, with deviations of a law.
class around_states {
 public:
  around_states(given_states states, const initial_states& law, double spread)
      : states_(std::make_shared<const given_states>(std::move(states))), law_(law), spread_(spread) {
    detail::fingerprint sum;
    for (const auto& x : *states_) {
      sum.add_all(x.q);
      sum.add_all(x.p);
    }
    const auto count = states_->size();
    description_ =
        fmt::format("given({} state{}, fingerprint={}{})", count, count == 1 ? "" : "s", sum.text(),
                    spread > 0.0 ? fmt::format(", spread={} of {}", spread, law.description()) : "");
  }

  phase_point<double, Eigen::Dynamic> operator()(std::uint64_t seed, std::uint64_t n) const {
    auto x = (*states_)[n % states_->size()];
    if (!(spread_ > 0.0)) return x;
    const auto one = law_(seed, 2 * n);
    const auto other = law_(seed, 2 * n + 1);
    const double factor = spread_ / std::sqrt(2.0);
    x.q += factor * (one.q - other.q);
    x.p += factor * (one.p - other.p);
    return x;
  }
  std::int64_t size() const {
    return spread_ > 0.0 ? std::numeric_limits<std::int64_t>::max() : std::ssize(*states_);
  }
  bool is_expensive() const { return spread_ > 0.0 && law_.is_expensive(); }
  std::string description() const { return description_; }

 private:
  std::shared_ptr<const given_states> states_;
  initial_states law_;
  double spread_;
  std::string description_;
};

/// What the columns of a table of starts are.
struct columns_of_starts {
  std::vector<std::size_t> q;
  std::vector<std::size_t> p;  // none: the table has no momenta
  std::optional<std::size_t> trajectory;
  std::optional<std::size_t> step;
};

columns_of_starts columns_of(const std::string& file, const std::vector<std::string>& names,
                             const initial_value_problem& made, const std::vector<std::string>& coordinates) {
  const Eigen::Index count = size(made.system);
  constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  std::array<std::vector<std::size_t>, 2> found;
  found.fill(std::vector<std::size_t>(static_cast<std::size_t>(count), none));
  columns_of_starts result;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::string& name = names[k];
    if (const auto at = place_of(name, coordinates, count)) {
      auto& column = found[at->is_momentum ? 1 : 0][static_cast<std::size_t>(at->index)];
      if (column != none) refuse_value("start", "{}: columns must differ, got {} by two names", file, name);
      column = k;
      continue;
    }
    if (name == "trajectory") result.trajectory = k;
    if (name == "step") result.step = k;
    // What `run` and `sample` write beside the state.
    constexpr std::array<std::string_view, 6> known{"trajectory", "step", "t", "chain", "draw", "potential"};
    if (std::ranges::find(known, name) != known.end() || is_built_in_observable(made, name) ||
        std::ranges::find(made.observables, name, &initial_value_problem::named_observable::name) !=
            made.observables.end()) {
      continue;
    }
    refuse_value("start", "{}: column {} must be one of {}, got '{}'; leave the column away", file, k + 1,
                 names_of_places(coordinates, count), name);
  }
  const auto missing = [&](const std::vector<std::size_t>& of) {
    return std::ranges::find(of, none) - of.begin();
  };
  if (const auto i = missing(found[0]); i < count) {
    refuse("{}: the first line must name the columns q1 to q{}, got no q{}", file, count, i + 1);
  }
  result.q = found[0];
  const bool has_momenta = std::ranges::any_of(found[1], [](std::size_t k) { return k != none; });
  if (!has_momenta) return result;
  if (const auto i = missing(found[1]); i < count) {
    refuse("{}: the first line must name the columns p1 to p{} or no momenta, got no p{}", file, count,
           i + 1);
  }
  result.p = found[1];
  return result;
}

/// Of an output of `run` the states at one step, or the last of each trajectory.
given_states at_one_step(const std::string& file, std::optional<std::int64_t> asked,
                         const std::vector<std::pair<double, double>>& labels, given_states all) {
  std::map<double, std::pair<double, std::size_t>> chosen;  // trajectory: step and row
  for (std::size_t row = 0; row < labels.size(); ++row) {
    const auto [trajectory, step] = labels[row];
    if (asked && step != static_cast<double>(*asked)) continue;
    const auto known = chosen.find(trajectory);
    if (known == chosen.end() || known->second.first <= step) chosen[trajectory] = {step, row};
  }
  if (chosen.empty()) refuse_value("start_step", "must be a step that {} has, got {}", file, *asked);
  given_states result;
  for (const auto& [trajectory, at] : chosen) result.push_back(std::move(all[at.second]));
  return result;
}

/// The states of an output of `run` in arrays, at one step, or where each trajectory was last.
given_states states_in_arrays(written_arrays& all, const columns_of_starts& columns, const std::string& file,
                              std::optional<std::int64_t> asked) {
  constexpr std::int64_t most_numbers = std::int64_t{1} << 22U;  // as of a table
  const std::int64_t columns_read = std::ssize(columns.q) + std::ssize(columns.p);
  if (all.trajectories() > most_numbers / columns_read) {
    refuse_value("start", "{}: states must have at most {} numbers, got {} trajectories of {}", file,
                 most_numbers, all.trajectories(), columns_read);
  }
  const auto count = static_cast<Eigen::Index>(columns.q.size());
  const auto state_at = [&](std::int64_t trajectory, std::int64_t sample) {
    phase_point<double, Eigen::Dynamic> x{Eigen::VectorXd(count), Eigen::VectorXd::Zero(count)};
    const auto read = [&](const std::vector<std::size_t>& from, Eigen::VectorXd& to) {
      for (std::size_t i = 0; i < from.size(); ++i)
        to[static_cast<Eigen::Index>(i)] = all.number(trajectory, sample, from[i]);
    };
    read(columns.q, x.q);
    read(columns.p, x.p);
    return x;
  };
  const std::int64_t last = asked ? *asked / all.every() : all.samples() - 1;
  const bool has_step = !asked || (*asked >= 0 && *asked % all.every() == 0 && last < all.samples());
  given_states result;
  for (std::int64_t m = 0; m < all.trajectories() && has_step; ++m) {
    for (std::int64_t sample = last; sample >= (asked ? last : 0); --sample) {
      auto x = state_at(m, sample);
      if (!is_finite(x)) continue;  // the trajectory had diverged
      result.push_back(std::move(x));
      break;
    }
  }
  if (result.empty() && asked) refuse_value("start_step", "must be a step that {} has, got {}", file, *asked);
  return result;
}

}  // namespace

phase_point<double, Eigen::Dynamic> state_of(const std::string& text,
                                             const std::vector<std::string>& coordinates,
                                             Eigen::Index count) {
  phase_point<double, Eigen::Dynamic> x{Eigen::VectorXd::Zero(count), Eigen::VectorXd::Zero(count)};
  std::array<std::vector<bool>, 2> is_said;
  is_said.fill(std::vector<bool>(static_cast<std::size_t>(count), false));
  std::string_view left = text;
  bool is_empty = true;
  while (!left.empty()) {
    const auto end = std::min(left.find_first_of(",;"), left.size());
    const std::string_view part = without_blanks(left.substr(0, end));
    left.remove_prefix(std::min(end + 1, left.size()));
    if (part.empty()) continue;
    is_empty = false;
    const auto equals = part.find('=');
    if (equals == std::string_view::npos || equals == 0) {
      refuse_value("at", "must be name=value,...;name=value,..., got '{}'", part);
    }
    const std::string name(without_blanks(part.substr(0, equals)));
    const auto at = place_of(name, coordinates, count);
    if (!at) {
      refuse("{}: names must be of {}, got '{}'", spelled("at"), names_of_places(coordinates, count), name);
    }
    auto said = is_said[at->is_momentum ? 1 : 0][static_cast<std::size_t>(at->index)];
    if (said) refuse("{}: names must differ, got {} twice", spelled("at"), name);
    said = true;
    const auto value = number_of<double>(spelled("at"), std::string(without_blanks(part.substr(equals + 1))));
    if (!std::isfinite(value)) refuse("{}: values must be finite, got {}={}", spelled("at"), name, value);
    (at->is_momentum ? x.p : x.q)[at->index] = value;
  }
  if (is_empty) refuse_value("at", "must be a state such as q1=1,p1=0.5, got '{}'", text);
  return x;
}

initial_states starts_at(given_states states, const initial_value_problem& made, double spread) {
  const Eigen::Index count = size(made.system);
  if (states.empty()) refuse("states to begin at must be given, got none");
  for (std::size_t n = 0; n < states.size(); ++n) {
    const auto& x = states[n];
    if (x.q.size() != count || x.p.size() != count || !is_finite(x)) {
      refuse("state {} to begin at must be {} finite coordinates and as many momenta", n + 1, count);
    }
    if (!has_energy(made.system)) continue;
    const double h = energy<double>(made.system, x);
    if (!std::isfinite(h)) refuse("state {} to begin at must have a finite energy, got {}", n + 1, h);
  }
  return around_states(std::move(states), made.starts, spread);
}

initial_states starts_in(const std::string& file, const initial_value_problem& made,
                         const std::vector<std::string>& coordinates, std::optional<std::int64_t> step,
                         double temperature, double spread) {
  columns_of_starts columns;
  given_states states;
  std::vector<std::pair<double, double>> labels;
  const Eigen::Index count = size(made.system);
  const auto header = [&](const std::vector<std::string>& names) {
    columns = columns_of(file, names, made, coordinates);
    if (spread > 0.0 && columns.p.empty()) {
      refuse_value("spread", "must come with momenta in {}, as those of positions are drawn; leave {} away",
                   file, spelled("spread"));
    }
  };
  if (is_of_arrays(file)) {
    written_arrays all(spelled("start"), file);
    header(all.observables());
    states = states_in_arrays(all, columns, file, step);
    step.reset();
  } else {
    read_csv(spelled("start"), file, header, [&](csv_row& row) {
      phase_point<double, Eigen::Dynamic> x{Eigen::VectorXd(count), Eigen::VectorXd::Zero(count)};
      for (std::size_t i = 0; i < columns.q.size(); ++i)
        x.q[static_cast<Eigen::Index>(i)] = row.number(columns.q[i]);
      for (std::size_t i = 0; i < columns.p.size(); ++i)
        x.p[static_cast<Eigen::Index>(i)] = row.number(columns.p[i]);
      states.push_back(std::move(x));
      if (columns.trajectory && columns.step)
        labels.emplace_back(row.number(*columns.trajectory), row.number(*columns.step));
    });
  }
  if (!labels.empty()) {
    states = at_one_step(file, step, labels, std::move(states));
  } else if (step) {
    refuse_value("start_step",
                 "must come with an output of run, got {}, which has no columns trajectory and step", file);
  }
  if (!columns.p.empty()) return starts_at(std::move(states), made, spread);
  std::vector<vector<double, Eigen::Dynamic>> positions;
  for (auto& x : states) positions.push_back(std::move(x.q));
  try {
    return thermal_positions(made.system, std::move(positions), temperature);
  } catch (const std::invalid_argument& problem) {
    refuse("cannot take {} {}: {}", spelled("start"), file, problem.what());
  }
}

}  // namespace nysalt::program
