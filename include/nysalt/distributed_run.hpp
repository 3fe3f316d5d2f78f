// SPDX-License-Identifier: BSL-1.0
// One trajectory of a system that several ranks share.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "nysalt/communicator.hpp"
#include "nysalt/method.hpp"
#include "nysalt/model.hpp"

namespace nysalt {

/// One trajectory of a LocalSystem by domain decomposition: each rank holds consecutive sites, steps them
/// tile by tile on the model's threads, and exchanges halos with the ranks next to it, once for some tens of
/// kicks. The bits depend neither on ranks nor on threads. Words of drifts and kicks in turn; no bath, no
/// processor.
///
///   distributed_run run(model(chain).on_threads(4), verlet{}, 0.01, start, mpi_communicator());
///   run.advance(1000);
///   if (ranks.is_first()) ...
///
/// All functions but the plain accessors are collective. Memory: q, p and f of the rank's sites, no more.
class distributed_run {
 public:
  /// Writes q and p of sites first, first + 1, ... to the spans, which have `components` numbers for each
  /// site.
  using start = std::function<void(Eigen::Index first, std::span<double> q, std::span<double> p)>;

  /// A run at the initial state. The communicator must outlive the run. Throws std::invalid_argument on all
  /// ranks if the system is no LocalSystem or is in a bath that acts, if the word is not drifts and kicks in
  /// turn or is processed, if the step is zero or not finite, if a start is not finite, or if there are more
  /// ranks than the sites can be shared by.
  distributed_run(const model& system, const nysalt::method& method, double step, const start& at,
                  const communicator& ranks = one_rank);
  ~distributed_run();
  distributed_run(distributed_run&&) noexcept;             ///< leaves the other one without a state
  distributed_run& operator=(distributed_run&&) noexcept;  ///< likewise

  /// Advances by `steps` steps. Throws std::invalid_argument if steps < 0.
  void advance(std::int64_t steps);
  /// The synchronous state of this rank's sites.
  phase_point<double, Eigen::Dynamic> synchronous() const;
  /// H, summed in a tree whose shape depends on the number of sites only. Throws std::invalid_argument if
  /// the system has no potential_in_range().
  double energy() const;
  /// Whether all numbers of all ranks are finite.
  bool is_finite() const;

  /// The run of this rank's sites: that is what a checkpoint keeps, and, one rank's after the other, what
  /// resume() takes on any number of ranks.
  const open_run<double, Eigen::Dynamic>& open() const;
  /// Goes on from a state that open() gave: read(first, q, p) as a start. Throws as the constructor.
  void resume(std::int64_t step, const start& read);

  std::int64_t step() const;        ///< number of steps done
  Eigen::Index first_site() const;  ///< first site of this rank
  Eigen::Index sites() const;       ///< sites of this rank

 private:
  struct parts;

  std::unique_ptr<parts> parts_;
};

namespace detail {
/// Whether the constructor of distributed_run admits this system and method on these ranks.
bool can_be_distributed(const model& system, const method& method, const communicator& ranks);
}  // namespace detail

}  // namespace nysalt
