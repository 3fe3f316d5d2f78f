// SPDX-License-Identifier: BSL-1.0
#include "nysalt/distributed_run.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>

#include "nysalt/communicator.hpp"
#include "nysalt/core/sentence.hpp"
#include "nysalt/core/tree_sum.hpp"
#include "nysalt/kernels/tiled_steps.hpp"

namespace nysalt {

using detail::side;
using detail::site_kernels;
using detail::site_layout;
using detail::site_window;
using detail::tile_letter;

namespace {

const site_kernels& sites_of(const model& system) {
  if (system.bath().acts()) {
    throw std::invalid_argument(
        sentence("distributed_run: the system must be in no bath, got {}", system.description()));
  }
  if (const site_kernels* sites = system.sites()) return *sites;
  throw std::invalid_argument(
      sentence("distributed_run: the system must be a LocalSystem, got {}; step this one on a single rank",
               system.description()));
}

/// Whether a word is drifts and kicks in turn.
bool is_in_turn(const std::string& letters) {
  return letters.size() > 1 && letters.find_first_not_of("AB") == std::string::npos &&
         letters.find("AA") == std::string::npos && letters.find("BB") == std::string::npos;
}

detail::step_program<double> letters_of(const model& system, const method& method, double step) {
  const nysalt::word& word = method.letters();
  if (word.is_processed()) {
    throw std::invalid_argument(
        sentence("distributed_run: the word must not be processed, got {}; take the word of the kernel",
                 method.name()));
  }
  if (!is_in_turn(word.letters())) {
    throw std::invalid_argument(
        sentence("distributed_run: the word must be drifts A and kicks B in turn, got {}", word.letters()));
  }
  (void)make_stepper(system, method, step);  // throws what is not a step
  detail::step_program<double> result =
      detail::prepared_word<double, Eigen::Dynamic>(system, word, method.coefficients(), step, {}).program();
  result.keeps_last_force = false;  // only a word whose letters merge reads that force, and computes it again
  return result;
}

/// Leaf first_of(r) is the first of rank r.
std::int64_t first_leaf_of(const site_layout& layout, int rank, int ranks) {
  const std::int64_t leaves = (layout.sites - 1) / sites_of_leaf(layout) + 1;
  return detail::first_of_part(leaves, rank, ranks);
}

Eigen::Index first_site_of(const site_layout& layout, int rank, int ranks) {
  if (rank == ranks) return layout.sites;
  return first_leaf_of(layout, rank, ranks) * sites_of_leaf(layout);
}

Eigen::Index share_of(const site_layout& layout, int rank, int ranks) {
  return first_site_of(layout, rank + 1, ranks) - first_site_of(layout, rank, ranks);
}
Eigen::Index least_share(const site_layout& layout) { return std::max<Eigen::Index>(layout.reach, 1); }

}  // namespace

bool detail::can_be_distributed(const model& system, const method& method, const communicator& ranks) {
  const nysalt::word& word = method.letters();
  if (system.bath().acts() || system.sites() == nullptr || word.is_processed() || !is_in_turn(word.letters()))
    return false;
  const site_layout layout = system.sites()->layout();
  for (int rank = 0; rank < ranks.size(); ++rank) {
    if (share_of(layout, rank, ranks.size()) < least_share(layout)) return false;
  }
  return true;
}

struct distributed_run::parts {
  parts(const model& of, const nysalt::method& method, double step, const communicator& among)
      : system(of),
        sites(&sites_of(system)),
        layout(sites->layout()),
        letters(letters_of(system, method, step)),
        ranks(&among),
        first(first_site_of(layout, among.rank(), among.size())),
        count(first_site_of(layout, among.rank() + 1, among.size()) - first) {
    require_shares();
    window.emplace(*sites, first, count, system.threads());
    // A halo comes from one neighbour; where a rank is its own only neighbour, from itself.
    const auto most =
        std::min<std::int64_t>(window->kicks_of_sweep(), count / std::max<Eigen::Index>(layout.reach, 1));
    kicks_of_sweep = static_cast<int>(
        among.minimum(among.is_single() && !layout.is_periodic ? window->kicks_of_sweep() : most));
    const auto numbers = static_cast<Eigen::Index>(layout.components) * count;
    run.state = {{Eigen::VectorXd(numbers), Eigen::VectorXd(numbers)}, Eigen::VectorXd::Zero(numbers)};
  }

  /// The same on all ranks, as each knows the shares of all.
  void require_shares() const {
    for (int rank = 0; rank < ranks->size(); ++rank) {
      if (share_of(layout, rank, ranks->size()) >= least_share(layout)) continue;
      throw std::invalid_argument(sentence(
          "distributed_run: {} must have at least {} sites a rank, a multiple of {}, got {} ranks; take "
          "fewer ranks",
          system.description(), layout.reach, sites_of_leaf(layout), ranks->size()));
    }
  }

  void fill(const start& at) {
    collectively(*ranks, [&] {
      at(first, {run.state.q.data(), static_cast<std::size_t>(run.state.q.size())},
         {run.state.p.data(), static_cast<std::size_t>(run.state.p.size())});
      if (run.state.q.allFinite() && run.state.p.allFinite()) return;
      throw std::invalid_argument(
          sentence("distributed_run: the start must be finite, got another number "
                   "between sites {} and {}",
                   first, first + count - 1));
    });
  }

  /// Halos for `kicks` kicks from the ranks on both sides, or of a single rank from itself.
  void exchange(int kicks, const double* q, const double* p) {
    const std::size_t size = window->halo_size(kicks);
    edge.resize(size);
    pass(side::right, kicks, q, p, left_halo);
    pass(side::left, kicks, q, p, right_halo);
  }
  /// The edge at that side becomes the halo, at the other side, of the rank next to it.
  void pass(side to, int kicks, const double* q, const double* p, std::vector<double>& halo) {
    const side from = to == side::right ? side::left : side::right;
    const bool sends = window->has_neighbour(to);
    const bool receives = window->has_neighbour(from);
    halo.resize(receives ? edge.size() : 0);
    if (sends) window->copy_edge(to, kicks, q, p, edge);
    const int ahead = to == side::right ? 1 : ranks->size() - 1;
    const int next = (ranks->rank() + ahead) % ranks->size();
    const int last = (ranks->rank() + ranks->size() - ahead) % ranks->size();
    if (next == ranks->rank()) {
      if (receives) halo = edge;
      return;
    }
    const auto send = [&] {
      if (sends) ranks->send(std::as_bytes(std::span(edge)), next);
    };
    const auto receive = [&] {
      if (receives) ranks->receive(std::as_writable_bytes(std::span(halo)), last);
    };
    // A send may wait for its receive: of two neighbours one has an odd number, but for the ends of a ring of
    // an odd number of ranks, where the chain of waiting ranks ends at the first odd one.
    if (ranks->rank() % 2 == 0) {
      send();
      receive();
    } else {
      receive();
      send();
    }
  }

  void sweep(std::span<const tile_letter> portion, double* q, double* p) {
    const auto kicks = static_cast<int>(std::ranges::count_if(portion, &tile_letter::is_kick));
    exchange(kicks, q, p);
    window->sweep(portion, q, p, nullptr, left_halo, right_halo);
  }
  /// The first letter of the word, of which an open run is ahead, or that letter back.
  void apply_first_letter(double sign, double* q, double* p) {
    if (letters.undo.empty()) return;
    const auto& back = letters.undo.front();
    const std::array<tile_letter, 1> letter{
        {{.coefficient = sign * back.coefficient, .is_kick = back.what == detail::action::kick}}};
    sweep(letter, q, p);
  }

  model system;
  const site_kernels* sites;
  site_layout layout;
  detail::step_program<double> letters;
  const communicator* ranks;
  Eigen::Index first;
  Eigen::Index count;
  std::optional<site_window> window;
  int kicks_of_sweep = 1;
  open_run<double, Eigen::Dynamic> run;
  std::vector<double> edge;
  std::vector<double> left_halo;
  std::vector<double> right_halo;
};

distributed_run::distributed_run(const model& system, const method& method, double step, const start& at,
                                 const communicator& ranks)
    : parts_(std::make_unique<parts>(system, method, step, ranks)) {
  parts_->fill(at);
  parts_->apply_first_letter(-1.0, parts_->run.state.q.data(), parts_->run.state.p.data());
}

distributed_run::~distributed_run() = default;
distributed_run::distributed_run(distributed_run&&) noexcept = default;
distributed_run& distributed_run::operator=(distributed_run&&) noexcept = default;

void distributed_run::advance(std::int64_t steps) {
  if (steps < 0)
    throw std::invalid_argument(sentence("distributed_run: steps must not be negative, got {}", steps));
  auto& state = parts_->run.state;
  detail::letters_in_portions letters(parts_->letters, steps);
  for (auto portion = letters.next(parts_->kicks_of_sweep); !portion.empty();
       portion = letters.next(parts_->kicks_of_sweep)) {
    parts_->sweep(portion, state.q.data(), state.p.data());
  }
  parts_->run.step += steps;
}

phase_point<double, Eigen::Dynamic> distributed_run::synchronous() const {
  phase_point<double, Eigen::Dynamic> result{parts_->run.state.q, parts_->run.state.p};
  parts_->apply_first_letter(1.0, result.q.data(), result.p.data());
  return result;
}

double distributed_run::energy() const {
  if (!parts_->layout.has_energy) {
    throw std::invalid_argument(
        sentence("distributed_run: a system must have a potential_in_range() for energy(), got {}",
                 parts_->system.description()));
  }
  const auto x = synchronous();
  parts_->exchange(1, x.q.data(), x.p.data());
  const auto ours =
      parts_->window->energies_of_leaves(x.q.data(), x.p.data(), parts_->left_halo, parts_->right_halo);
  return tree_sum(all_gather(*parts_->ranks, ours));
}

bool distributed_run::is_finite() const {
  const bool ours = parts_->run.state.q.allFinite() && parts_->run.state.p.allFinite();
  return parts_->ranks->minimum(ours ? 1 : 0) == 1;
}

const open_run<double, Eigen::Dynamic>& distributed_run::open() const { return parts_->run; }

void distributed_run::resume(std::int64_t step, const start& read) {
  if (step < 0)
    throw std::invalid_argument(sentence("distributed_run: a step must not be negative, got {}", step));
  parts_->fill(read);
  parts_->run.step = step;
}

std::int64_t distributed_run::step() const { return parts_->run.step; }
Eigen::Index distributed_run::first_site() const { return parts_->first; }
Eigen::Index distributed_run::sites() const { return parts_->count; }

}  // namespace nysalt
