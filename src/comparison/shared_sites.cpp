// SPDX-License-Identifier: BSL-1.0
#include "shared_sites.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "nysalt/communicator.hpp"
#include "nysalt/distributed_run.hpp"
#include "observables.hpp"

namespace nysalt::program {

namespace {

using state = phase_point<double, Eigen::Dynamic>;

/// The numbers of all ranks, one rank's after the other, at rank 0; elsewhere nothing.
Eigen::VectorXd gather(const communicator& ranks, const Eigen::VectorXd& ours) {
  const std::vector<Eigen::Index> sizes = all_gather(ranks, ours.size());
  const auto bytes = [](double* numbers, Eigen::Index count) {
    return std::as_writable_bytes(std::span(numbers, static_cast<std::size_t>(count)));
  };
  if (!ranks.is_first()) {
    ranks.send(std::as_bytes(std::span(ours.data(), static_cast<std::size_t>(ours.size()))), 0);
    return {};
  }
  Eigen::VectorXd all(std::accumulate(sizes.begin(), sizes.end(), Eigen::Index{0}));
  all.head(ours.size()) = ours;
  Eigen::Index first = sizes[0];
  for (int r = 1; r < ranks.size(); ++r) {
    const Eigen::Index count = sizes[static_cast<std::size_t>(r)];
    ranks.receive(bytes(all.data() + first, count), r);
    first += count;
  }
  return all;
}

/// Of numbers that rank 0 has, to each rank as many as it asks for, in the order of the ranks.
Eigen::VectorXd scatter(const communicator& ranks, std::span<const double> all, Eigen::Index ours) {
  const std::vector<Eigen::Index> sizes = all_gather(ranks, ours);
  Eigen::VectorXd result(ours);
  if (!ranks.is_first()) {
    ranks.receive(std::as_writable_bytes(std::span(result.data(), static_cast<std::size_t>(ours))), 0);
    return result;
  }
  std::ranges::copy(all.first(static_cast<std::size_t>(ours)), result.data());
  auto first = static_cast<std::size_t>(ours);
  for (int r = 1; r < ranks.size(); ++r) {
    const auto count = static_cast<std::size_t>(sizes[static_cast<std::size_t>(r)]);
    ranks.send(std::as_bytes(all.subspan(first, count)), r);
    first += count;
  }
  return result;
}

distributed_run::start values_of(const Eigen::VectorXd& our_q, const Eigen::VectorXd& our_p) {
  return [&our_q, &our_p](Eigen::Index, std::span<double> q, std::span<double> p) {
    std::ranges::copy(our_q, q.begin());
    std::ranges::copy(our_p, p.begin());
  };
}

/// One trajectory, with the checks for divergence of a lockstep.
class shared_trajectory {
 public:
  shared_trajectory(const model& system, const nysalt::method& method, double step, const state& start,
                    const communicator& ranks)
      : system_(&system),
        ranks_(&ranks),
        run_(system, method, step, part_of(start, system.sites()->layout().components), ranks),
        diverged_(system, start),
        has_energy_(has_energy(system) && system.sites()->layout().has_energy),
        initial_(has_energy_ ? run_.energy() : 0.0) {}

  /// Goes on to step `end`, unless the trajectory has diverged. At each step n that `every` divides read(x)
  /// returns numbers of the whole state at rank 0, which take() is given where the trajectory is good at n.
  void go_on(std::int64_t end, std::int64_t every, const auto& read, const auto& take) {
    while (run_.step() < end && !diverged_at_) {
      const open_run<double, Eigen::Dynamic> good = run_.open();
      const std::int64_t next =
          std::min((run_.step() / steps_between_checks + 1) * steps_between_checks, end);
      std::vector<std::vector<double>> samples;  // of rank 0
      for (std::int64_t n = (good.step / every + 1) * every; n <= next; n += every) {
        run_.advance(n - run_.step());
        const state x = whole();
        collectively(*ranks_, [&] {
          if (ranks_->is_first()) samples.push_back(read(x));
        });
      }
      run_.advance(next - run_.step());
      if (has_diverged()) find_first_bad_step(good, next);
      std::int64_t n = good.step / every * every;
      for (const auto& values : samples) {
        n += every;
        if (!diverged_at_ || n < *diverged_at_) take(values);
      }
    }
  }

  std::int64_t step() const { return run_.step(); }
  std::optional<std::int64_t> diverged_at() const { return diverged_at_; }
  /// |H - H_0| of the whole state where it is, with the bits of one process. Called by all ranks.
  double energy_error() {
    const state x = whole();
    double result = 0.0;
    collectively(*ranks_, [&] {
      if (!ranks_->is_first()) return;
      diverged_(x);
      result = diverged_.last_change();
    });
    broadcast(*ranks_, result);
    return result;
  }

  /// q, p and f of the open run at rank 0, elsewhere nothing. f is the force at q, which is what words keep
  /// that keep one.
  std::vector<double> save() const {
    state open{gather(*ranks_, run_.open().state.q), gather(*ranks_, run_.open().state.p)};
    if (!ranks_->is_first()) return {};
    const Eigen::Index n = open.size();
    if (diverged_at_) return std::vector<double>(static_cast<std::size_t>(3 * n), 0.0);
    Eigen::VectorXd force(n);
    system_->force(open.q, force);
    std::vector<double> result;
    result.reserve(static_cast<std::size_t>(3 * n));
    for (const Eigen::VectorXd* part : {&open.q, &open.p, &force})
      result.insert(result.end(), part->begin(), part->end());
    return result;
  }
  /// Goes on from what save() gave, which rank 0 has, at that step.
  void resume(std::int64_t step, std::span<const double> saved, std::optional<std::int64_t> diverged_at) {
    diverged_at_ = diverged_at;
    ranks_->broadcast(std::as_writable_bytes(std::span(&diverged_at_, 1)), 0);
    const auto n = static_cast<std::size_t>(size(*system_));
    const Eigen::Index ours = run_.open().state.q.size();
    const bool is_first = ranks_->is_first();
    const Eigen::VectorXd q = scatter(*ranks_, is_first ? saved.first(n) : saved, ours);
    const Eigen::VectorXd p = scatter(*ranks_, is_first ? saved.subspan(n, n) : saved, ours);
    run_.resume(step, values_of(q, p));
  }

 private:
  static distributed_run::start part_of(const state& x, Eigen::Index components) {
    return [&x, components](Eigen::Index first, std::span<double> q, std::span<double> p) {
      const Eigen::Index begin = first * components;
      std::copy_n(x.q.data() + begin, q.size(), q.begin());
      std::copy_n(x.p.data() + begin, p.size(), p.begin());
    };
  }

  /// The synchronous state at rank 0.
  state whole() const {
    const state ours = run_.synchronous();
    state result;
    result.q = gather(*ranks_, ours.q);
    result.p = gather(*ranks_, ours.p);
    return result;
  }

  /// What `divergence` says of the whole state. The sum of the ranks' energies decides where it is off by
  /// less than .999 of what is allowed, as it differs from the energy of the whole state by rounding; where
  /// it does not decide, rank 0 does with the whole state.
  bool has_diverged() {
    if (has_energy_ && run_.is_finite()) {
      const double change = std::abs(run_.energy() - initial_);
      if (change <= 0.999 * diverged_.largest_change()) return false;
    } else if (!has_energy(*system_)) {
      return !run_.is_finite();
    }
    const state x = whole();
    bool result = ranks_->is_first() && diverged_(x);
    broadcast(*ranks_, result);
    return result;
  }

  /// The steps since the last check once more, one at a time.
  void find_first_bad_step(const open_run<double, Eigen::Dynamic>& good, std::int64_t end) {
    run_.resume(good.step, values_of(good.state.q, good.state.p));
    do {
      run_.advance(1);
    } while (run_.step() < end && !has_diverged());
    diverged_at_ = run_.step();
  }

  const model* system_;
  const communicator* ranks_;
  distributed_run run_;
  detail::divergence<model, double> diverged_;
  bool has_energy_;  // that ranks can sum
  double initial_;   // the sum of the ranks
  std::optional<std::int64_t> diverged_at_;
};

}  // namespace

double run_on_shared_sites(const initial_value_problem& made, const initial_states& starts,
                           const method& method, const sampled_plan& plan, const record_taker& take,
                           const counter& progress, const communicator& ranks) {
  const trajectories_plan& all = plan.trajectories;
  const model system = made.system.on_threads(all.threads);
  std::vector<nysalt::detail::over_scalars<nysalt::detail::of_state>> watched;
  for (const auto& name : plan.observables) watched.push_back(observable(made, name));
  const auto read = [&](const state& x) {
    std::vector<double> values;
    for (const auto& one : watched) values.push_back(one(x));
    return values;
  };
  std::int64_t first = plan.from.first;  // of rank 0
  std::int64_t under_way = std::ssize(plan.from.batch.diverged_at);
  bool is_prolonged = plan.left != nullptr;
  for (std::int64_t* number : {&first, &under_way}) broadcast(ranks, *number);
  broadcast(ranks, is_prolonged);
  double energy_error = plan.from.energy_error;
  broadcast(ranks, energy_error);
  while (first < all.count) {
    const std::int64_t count = under_way > 0 ? under_way : all.count - first;
    const bool goes_on = under_way > 0 || is_prolonged;
    saved_runs saved = goes_on ? runs_at_first(plan, first, count, ranks) : saved_runs();
    broadcast(ranks, saved.step);
    std::vector<shared_trajectory> runs;
    std::vector<record> records(static_cast<std::size_t>(count));
    for (std::int64_t i = 0; i < count; ++i) {
      std::optional<state> start;
      collectively(ranks, [&] { start = sound_start(system, starts, all.seed, first + i); });
      runs.emplace_back(system, method, all.step, *start, ranks);
      const auto at = static_cast<std::size_t>(i);
      if (goes_on) {
        const auto each = static_cast<std::size_t>(3 * size(system));
        const bool is_first = ranks.is_first();
        runs.back().resume(saved.step,
                           is_first ? std::span(saved.numbers).subspan(at * each, each) : std::span<double>(),
                           is_first ? saved.diverged_at[at] : std::nullopt);
      } else {
        on_first(ranks, [&] { records[at].values = read(*start); });
      }
    }
    for (std::int64_t step = saved.step, end; step < all.steps; step = end) {
      end = end_of_segment(step, all.steps, plan.segment);
      const std::int64_t before = step > 0 ? step : -1;
      for (std::size_t i = 0; i < runs.size(); ++i) {
        if (step > 0) records[i] = {};
        records[i].first = (before + plan.every) / plan.every * plan.every;
        auto& values = records[i].values;
        runs[i].go_on(end, plan.every, read, [&](const std::vector<double>& of_step) {
          values.insert(values.end(), of_step.begin(), of_step.end());
        });
        const auto lost = runs[i].diverged_at();
        if (lost && *lost > before) records[i].diverged_at = lost;
        on_first(ranks, [&] {
          const auto m = first + static_cast<std::int64_t>(i);
          if (!records[i].values.empty() || records[i].diverged_at) take(m, records[i]);
          if (!progress) return;
          const double of_batch = (static_cast<double>(step) * static_cast<double>(runs.size() - i - 1) +
                                   static_cast<double>(end) * static_cast<double>(i + 1)) /
                                  static_cast<double>(all.steps);
          progress(static_cast<std::int64_t>(1000.0 * (static_cast<double>(first) + of_batch) /
                                             static_cast<double>(all.count)));
        });
      }
      if (!is_handed_over(plan, end)) continue;
      saved_runs here{.step = end, .numbers = {}, .diverged_at = {}};
      for (const auto& one : runs) {
        const std::vector<double> numbers = one.save();
        here.numbers.insert(here.numbers.end(), numbers.begin(), numbers.end());
        here.diverged_at.push_back(one.diverged_at());
      }
      report_segment(plan, {first, std::move(here), energy_error}, end, ranks);
    }
    for (auto& one : runs) {
      if (!one.diverged_at()) energy_error = std::max(energy_error, one.energy_error());
    }
    first += count;
    under_way = 0;
    if (plan.segment) report_reached(plan, {first, {}, energy_error}, ranks);
  }
  return energy_error;
}

}  // namespace nysalt::program
