// SPDX-License-Identifier: BSL-1.0

#include "data_of_problem.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <random>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "../losses/windows.hpp"
#include "nysalt/communicator.hpp"
#include "nysalt/core/sentence.hpp"
#include "nysalt/derivatives/check_force.hpp"
#include "nysalt/derivatives/spectrum.hpp"
#include "nysalt/ensembles/starts_to_judge.hpp"
#include "nysalt/noises/counter_noise.hpp"

namespace nysalt::detail {

bool begin_alike(const flow_map_data& a, const flow_map_data& b) {
  const communicator& ranks = a.share().ranks();
  bool result = false;
  if (ranks.is_first()) {
    const bool other_noise = a.noise_parts > 0 && a.noise_parts == b.noise_parts && a.noise[0] != b.noise[0];
    result = a.start[0].q == b.start[0].q && a.start[0].p == b.start[0].p && !other_noise;
  }
  broadcast(ranks, result);
  return result;
}

double error_of_reference(const flow_map_data& data, const metric& measure) {
  std::vector<double> squares(data.trajectories(), 0.0);
  Eigen::VectorXd r(measure.residuals());
  for (const auto& [pair, finish] : data.finer) {
    double& of_trajectory = squares[data.trajectory_of(pair)];
    measure.residual(finish.q, finish.p, data.finish[pair], r.data());
    for (const double x : r) of_trajectory += x * x;
  }
  const auto checks = data.share().ranks().sum(std::ssize(data.finer));
  const double difference = std::sqrt(data.share().sum(squares) / static_cast<double>(checks));
  return data.noise_parts > 0 ? error_over_difference * difference : difference;
}

int shortest_of(const flow_map_data& data) {
  std::size_t least = data.all_pairs();
  for (std::size_t m = 0; m < data.trajectories(); ++m) {
    least = std::min(least, data.first_of[m + 1] - data.first_of[m]);
  }
  const auto of_all = data.share().ranks().minimum(static_cast<std::int64_t>(least));
  return static_cast<int>(std::max<std::int64_t>(of_all, 1));
}

Eigen::VectorXd motion_in(const flow_map_data& data, const metric& measure, const after_steps_options& how) {
  const auto last = static_cast<std::size_t>(how.steps.back());
  const window_starts starts(data, last, static_cast<std::size_t>(how.apart));
  const double terms =
      static_cast<double>(data.share().ranks().sum(std::ssize(starts.pairs)) * std::ssize(how.steps));
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(measure.residuals());
  std::vector<Eigen::VectorXd> squares(data.trajectories(), zero);
  Eigen::VectorXd r = zero;
  for (std::size_t m = 0; m < data.trajectories(); ++m) {
    for (std::size_t n = starts.first_of[m]; n < starts.first_of[m + 1]; ++n) {
      const std::size_t first = starts.pairs[n];
      for (const int steps : how.steps) {
        const auto& finish = data.finish[first + static_cast<std::size_t>(steps) - 1];
        measure.residual(finish.q, finish.p, data.start[first], r.data());
        squares[m] += r.cwiseAbs2() / terms;
      }
    }
  }
  return data.share().sum(squares, zero);
}

int trajectories_apart(const flow_map_data& data, Eigen::Index coordinates) {
  constexpr std::int64_t enough = 1200;  // coordinates of all trajectories
  constexpr std::int64_t least = 16;
  const std::int64_t all = data.share().total();
  return static_cast<int>(
      std::clamp<std::int64_t>(all * coordinates / enough, 1, std::max<std::int64_t>(all / least, 1)));
}

flow_map_data coarser(const flow_map_data& data, int times) {
  const auto each = static_cast<std::size_t>(times);
  flow_map_data result;
  result.step = data.step * times;
  result.system = data.system;
  result.ensemble = data.ensemble;
  result.reference = data.reference;
  result.seed = data.seed;
  result.first_of.push_back(0);
  for (std::size_t m = 0; m < data.trajectories(); ++m) {
    const std::size_t whole = (data.first_of[m + 1] - data.first_of[m]) / each;
    for (std::size_t n = 0; n < whole; ++n) {
      const std::size_t first = data.first_of[m] + n * each;
      result.start.push_back(data.start[first]);
      result.finish.push_back(data.finish[first + each - 1]);
    }
    result.first_of.push_back(result.start.size());
  }
  if (!data.shared) return result;
  const shard share = data.share();
  std::vector<std::uint64_t> pairs(static_cast<std::size_t>(share.total()));
  for (std::size_t m = 0; m < data.trajectories(); ++m) {
    pairs[static_cast<std::size_t>(share.first()) + m] = result.first_of[m + 1] - result.first_of[m];
  }
  share.gather(pairs);
  std::size_t first = 0;
  std::size_t total = 0;
  for (std::size_t m = 0; m < pairs.size(); ++m) {
    if (static_cast<std::int64_t>(m) < share.first()) first += pairs[m];
    total += pairs[m];
  }
  result.shared = shared_pairs{share, first, total};
  return result;
}

after_steps_options in_longer_steps(const after_steps_options& how, int times, int shortest) {
  after_steps_options result = how;
  result.steps.clear();
  for (const int k : how.steps) {
    const int nearest = std::max(1, static_cast<int>(std::lround(static_cast<double>(k) / times)));
    const int possible = std::min(nearest, shortest / times);
    if (possible >= 1 && (result.steps.empty() || result.steps.back() < possible))
      result.steps.push_back(possible);
  }
  result.apart = std::max(1, how.apart / times);
  return result;
}

// Trajectories of data that go to other ranks.

namespace {

/// All doubles of trajectories begin .. end - 1 of this rank, by their places here: how many finer finishes
/// there are and of which of these pairs, then states and noise.
std::vector<double> packed(const flow_map_data& data, std::size_t begin, std::size_t end) {
  std::vector<double> numbers;
  const auto add = [&](const auto& values) { numbers.insert(numbers.end(), values.begin(), values.end()); };
  const auto add_state = [&](const auto& x) {
    add(x.q);
    add(x.p);
  };
  const std::size_t first = data.first_of[begin];
  const std::size_t last = data.first_of[end];
  numbers.push_back(static_cast<double>(end - begin));
  for (std::size_t m = begin; m < end; ++m) {
    numbers.push_back(static_cast<double>(data.first_of[m + 1] - data.first_of[m]));
  }
  const auto is_here = [&](const auto& finer_finish) {
    return first <= finer_finish.first && finer_finish.first < last;
  };
  numbers.push_back(static_cast<double>(std::ranges::count_if(data.finer, is_here)));
  for (const auto& finer_finish : data.finer) {
    if (!is_here(finer_finish)) continue;
    numbers.push_back(static_cast<double>(finer_finish.first - first));
    add_state(finer_finish.second);
  }
  const auto parts = static_cast<std::size_t>(data.noise_parts);
  for (std::size_t n = first; n < last; ++n) {
    add_state(data.start[n]);
    add_state(data.finish[n]);
    for (std::size_t k = 0; k < parts; ++k) add(data.noise[n * parts + k]);
  }
  return numbers;
}

/// Puts them behind those that there are.
void unpack(std::span<const double> numbers, Eigen::Index dimension, flow_map_data& data) {
  const auto take = [&] {
    const double x = numbers.front();
    numbers = numbers.subspan(1);
    return x;
  };
  const auto take_count = [&] { return static_cast<std::size_t>(take()); };
  const auto take_vector = [&] {
    Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(numbers.data(), dimension);
    numbers = numbers.subspan(static_cast<std::size_t>(dimension));
    return x;
  };
  const auto take_state = [&] {
    phase_point<double, Eigen::Dynamic> x;
    x.q = take_vector();
    x.p = take_vector();
    return x;
  };
  const std::size_t first = data.pairs();
  const std::size_t trajectories = take_count();
  for (std::size_t m = 0; m < trajectories; ++m) data.first_of.push_back(data.first_of.back() + take_count());
  const std::size_t finer = take_count();
  for (std::size_t k = 0; k < finer; ++k) {
    const std::size_t pair = first + take_count();
    data.finer.emplace_back(pair, take_state());
  }
  while (data.pairs() < data.first_of.back()) {
    data.start.push_back(take_state());
    data.finish.push_back(take_state());
    for (int k = 0; k < data.noise_parts; ++k) data.noise.push_back(take_vector());
  }
}

}  // namespace

void redistribute(flow_map_data& data, const shard& next, Eigen::Index dimension) {
  const shard now = data.share();
  const communicator& ranks = next.ranks();
  if (ranks.is_single()) return;
  flow_map_data kept;
  kept.first_of = {0};
  kept.noise_parts = data.noise_parts;
  for (int from = 0; from < ranks.size(); ++from) {
    for (int to = 0; to < ranks.size(); ++to) {
      if (from != ranks.rank() && to != ranks.rank()) continue;
      const std::int64_t begin = std::max(now.first_of(from), next.first_of(to));
      const std::int64_t end = std::min(now.first_of(from + 1), next.first_of(to + 1));
      if (begin >= end) continue;
      std::vector<double> numbers;
      if (from == ranks.rank()) {
        const auto place = [&](std::int64_t m) { return static_cast<std::size_t>(m - now.first()); };
        numbers = packed(data, place(begin), place(end));
      }
      if (from != to) {
        auto length = static_cast<std::int64_t>(numbers.size());
        const std::span length_message(&length, 1);
        if (from == ranks.rank()) {
          ranks.send(std::as_bytes(length_message), to);
          ranks.send(std::as_bytes(std::span(numbers)), to);
          continue;
        }
        ranks.receive(std::as_writable_bytes(length_message), from);
        numbers.resize(static_cast<std::size_t>(length));
        ranks.receive(std::as_writable_bytes(std::span(numbers)), from);
      }
      unpack(numbers, dimension, kept);
    }
  }
  data.start = std::move(kept.start);
  data.finish = std::move(kept.finish);
  data.noise = std::move(kept.noise);
  data.first_of = std::move(kept.first_of);
  data.finer = std::move(kept.finer);
}

}  // namespace nysalt::detail

namespace nysalt {

namespace {

[[noreturn]] void refuse_size(const char* what, std::size_t n, Eigen::Index found, Eigen::Index wanted) {
  throw std::invalid_argument(sentence(
      "{} {} of the data must have the dimension of the system, got {} for {}", what, n, found, wanted));
}

void require_valid_here(const flow_map_data& data, const model& system) {
  const auto number_of = [&](std::size_t pair) { return data.first_pair() + pair; };
  const auto trajectory_of = [&](std::size_t pair) {
    return static_cast<std::size_t>(data.share().first()) + data.trajectory_of(pair);
  };
  if (data.system != describe(system)) {
    throw std::invalid_argument(sentence("learn: the data must be of the system, got data of {} for {}",
                                         data.system, describe(system)));
  }
  const bool covers = !data.first_of.empty() && data.first_of.front() == 0 &&
                      data.first_of.back() == data.pairs() &&
                      std::is_sorted(data.first_of.begin(), data.first_of.end());
  if (data.all_pairs() == 0 || data.finish.size() != data.pairs() || !covers) {
    throw std::invalid_argument(
        sentence("learn: the data must be whole, got {} starts, {} finishes, {} trajectories", data.pairs(),
                 data.finish.size(), data.trajectories()));
  }
  if (data.noise_parts < 0 ||
      data.noise.size() != data.pairs() * static_cast<std::size_t>(data.noise_parts)) {
    throw std::invalid_argument(
        sentence("learn: the data must be whole, got {} pairs with noise in {} parts that hold {}",
                 data.pairs(), data.noise_parts, data.noise.size()));
  }
  if (data.step == 0.0 || !std::isfinite(data.step)) {
    throw std::invalid_argument(
        sentence("learn: the step of the data must be positive and finite, got {}", data.step));
  }
  for (std::size_t n = 0; n < data.noise.size(); ++n) {
    const auto noise = data.noise[n];
    if (noise.size() != size(system)) refuse_size("noise", n, noise.size(), size(system));
    for (Eigen::Index i = 0; i < noise.size(); ++i) {
      if (std::isfinite(noise[i])) continue;
      const std::size_t pair = n / static_cast<std::size_t>(data.noise_parts);
      throw std::invalid_argument(sentence(
          "learn: the data must be finite, got coordinate {} of noise {} = {}, in pair {} of trajectory {}",
          i + 1, n, noise[i], number_of(pair), trajectory_of(pair)));
    }
  }
  const auto require_sound = [&](const char* what, std::size_t pair, const auto& x) {
    if (x.q.size() != size(system)) refuse_size(what, pair, x.q.size(), size(system));
    if (x.p.size() != size(system)) refuse_size(what, pair, x.p.size(), size(system));
    if (is_finite(x)) return;
    throw std::invalid_argument(sentence(
        "learn: the {} of pair {} of the data, in trajectory {}, must be finite: {}", what, number_of(pair),
        trajectory_of(pair), detail::not_finite_in(phase_point<double, Eigen::Dynamic>(x))));
  };
  for (std::size_t n = 0; n < data.pairs(); ++n) {
    require_sound("start", n, data.start[n]);
    require_sound("finish", n, data.finish[n]);
  }
  for (const auto& [pair, finish] : data.finer) {
    if (pair >= data.pairs()) {
      throw std::invalid_argument(
          sentence("learn: the data must be whole, got a finer finish of pair {} of {}", pair, data.pairs()));
    }
    require_sound("finer finish", pair, finish);
  }
}

}  // namespace

void require_valid(const flow_map_data& data, const model& system) {
  collectively(data.share().ranks(), [&] { require_valid_here(data, system); });
}

namespace {

/// Of this rank's states, those of some pairs of all, by their numbers, which rise: at all ranks.
phase_points states_of(const phase_points& mine, const flow_map_data& data, Eigen::Index dimension,
                       const std::vector<std::size_t>& pairs) {
  const auto size = static_cast<std::size_t>(dimension);
  std::vector<double> numbers;  // q and p of one after the other
  for (const std::size_t pair : pairs) {
    if (pair < data.first_pair() || pair >= data.first_pair() + data.pairs()) continue;
    const auto x = mine[pair - data.first_pair()];
    numbers.insert(numbers.end(), x.q.begin(), x.q.end());
    numbers.insert(numbers.end(), x.p.begin(), x.p.end());
  }
  numbers = all_gather(data.share().ranks(), numbers);
  phase_points result(pairs.size(), dimension);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const double* q = numbers.data() + 2 * size * k;
    result.set(
        k, detail::listed_point<Eigen::Map<const Eigen::VectorXd>>{{q, dimension}, {q + size, dimension}});
  }
  return result;
}

/// Numbers, among those of all ranks, of the pairs at whose starts the force changes most along itself and
/// along a direction of chance: where the highest frequency may be.
std::vector<std::size_t> stiffest_pairs(const model& system, const flow_map_data& data, std::size_t most) {
  std::vector<double> scored;  // a score and a number, of one pair after the other
  {
    const auto motion = starts_of(data, size(system), detail::spread_pairs(data.all_pairs(), most));
    detail::force_jacobian jacobian(system, motion);
    auto v = detail::make_vector<double>(system);
    std::mt19937_64 bits{1};
    auto chance = v;
    for (double& x : chance) x = detail::uniform_by_bits(bits()) - 0.5;
    chance /= chance.norm();
    std::vector<std::pair<double, std::size_t>> scores;
    for (std::size_t pair = 0; pair < data.pairs(); ++pair) {
      const Eigen::VectorXd q = data.start[pair].q;
      force<double>(system, q, v);
      const double length = v.norm();
      if (length > 0.0) v /= length;
      v += chance;
      jacobian.move_to(q);
      const double score = jacobian.times(v).norm();
      if (std::isfinite(score)) scores.emplace_back(-score, data.first_pair() + pair);  // the largest first
    }
    const auto kept = static_cast<std::ptrdiff_t>(std::min(most, scores.size()));
    std::partial_sort(scores.begin(), scores.begin() + kept, scores.end());
    for (std::ptrdiff_t k = 0; k < kept; ++k) {
      scored.push_back(scores[static_cast<std::size_t>(k)].first);
      scored.push_back(static_cast<double>(scores[static_cast<std::size_t>(k)].second));
    }
    scored = all_gather(data.share().ranks(), scored);
  }
  std::vector<std::pair<double, std::size_t>> all;
  for (std::size_t k = 0; k + 1 < scored.size(); k += 2) {
    all.emplace_back(scored[k], static_cast<std::size_t>(scored[k + 1]));
  }
  std::ranges::sort(all);
  std::vector<std::size_t> result;
  for (std::size_t k = 0; k < std::min(most, all.size()); ++k) result.push_back(all[k].second);
  return result;
}

}  // namespace

phase_points starts_of(const flow_map_data& data, Eigen::Index dimension,
                       const std::vector<std::size_t>& pairs) {
  return states_of(data.start, data, dimension, pairs);
}

phase_points finishes_of(const flow_map_data& data, Eigen::Index dimension,
                         const std::vector<std::size_t>& pairs) {
  return states_of(data.finish, data, dimension, pairs);
}

states_of_data some_states(const model& system, const flow_map_data& data) {
  constexpr std::size_t spread = 128;
  constexpr std::size_t stiffest = 32;
  auto result = starts_of(data, size(system), detail::spread_pairs(data.all_pairs(), spread));
  const std::size_t typical = result.size();
  auto pairs = stiffest_pairs(system, data, stiffest);
  std::ranges::sort(pairs);
  result.append(starts_of(data, size(system), pairs));
  result.append(data.further_starts);
  return {std::move(result), typical};
}

phase_points judged_starts_of(const model& system, const flow_map_data& data, const flow_map_data& held_out) {
  if (!data.judged_starts.empty()) return data.judged_starts;
  constexpr std::size_t most = 512;
  const auto trajectories = static_cast<std::size_t>(held_out.share().total());
  std::vector<std::size_t> pairs;
  for (const std::size_t m : detail::spread_pairs(trajectories, most)) {
    // The first pair of a trajectory, where all are of one length; else a state of the same motion.
    pairs.push_back(m * (held_out.all_pairs() / trajectories));
  }
  return starts_of(held_out, size(system), pairs);
}

void require_sound_force(const model& system, const flow_map_data& data) {
  if (!system.facts().may_be_wrong) return;
  constexpr std::size_t enough = 4;
  std::vector<std::size_t> pairs;
  for (std::size_t k = 0; k < std::min(enough, data.all_pairs()); ++k) {
    pairs.push_back(data.all_pairs() * (2 * k + 1) / (2 * enough));
  }
  std::vector<Eigen::VectorXd> points;
  std::vector<Eigen::VectorXd> momenta;
  for (const auto& state : starts_of(data, size(system), pairs)) {
    points.emplace_back(state.q);
    momenta.emplace_back(state.p);
  }
  const force_check found = check_force(system, points, momenta, finishes_of(data, size(system), pairs));
  if (found.passed()) return;
  throw std::invalid_argument(
      sentence("cannot learn on {}: {}; mend the system, or learn with check_force = false", describe(system),
               found.report()));
}

}  // namespace nysalt
