// SPDX-License-Identifier: BSL-1.0
// Loops over trajectories and over blocks of them, on several threads and ranks: the driver of ensembles.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>

#include "nysalt/communicator.hpp"
#include "nysalt/core/sentence.hpp"
#include "nysalt/execution.hpp"
#include "nysalt/shard.hpp"
#include "nysalt/system.hpp"

namespace nysalt {

namespace detail {

/// Calls body(first, n) once for each block of n <= width consecutive trajectories first .. first + n - 1, of
/// `count` in all, on the threads of `how`, in no certain order; only the last block is shorter. A body
/// writes what it finds into the places of its trajectories; a sum over them is then taken by tree_sum, and
/// neither width nor the number of threads changes a bit. With one thread the order is the order of the
/// trajectories, and no thread is made. Progress is called after each block with the number of trajectories
/// done. Ranks are ignored: the trajectories are those of this rank.
///
/// If a body throws, its trajectories are run again, one after the other, so that what leaves the
/// loop is the exception of the first trajectory that has one, for any width and threads; some beyond it are
/// not visited. Each body begins with rounding to nearest and with subnormal numbers kept, whatever the
/// thread has. Throws std::invalid_argument if threads or width are below 1, or if a body changes that.
void for_each_block(std::int64_t count, int width, const execution& how,
                    const std::function<void(std::int64_t, int)>& body);

}  // namespace detail

/// Calls body(m) for m = 0 .. count - 1: blocks of one.
void for_each_trajectory(std::int64_t count, const execution& how,
                         const std::function<void(std::int64_t)>& body);

namespace detail {

/// The number of trajectories, and of steps of each, that have noise of their own.
inline constexpr std::int64_t numbers_with_own_noise = std::int64_t{1} << 48U;

/// Throws std::invalid_argument, in the name of `who`, unless trajectories first .. first + count - 1 are one
/// or more and have noise of their own.
inline void require_trajectories(const char* who, std::int64_t count, std::int64_t first) {
  if (count >= 1 && first >= 0 && count <= numbers_with_own_noise && first <= numbers_with_own_noise - count)
    return;
  throw std::invalid_argument(sentence(
      "{}: trajectories must be >= 1, first >= 0, and first + trajectories <= 2^48, got trajectories "
      "{} and first {}",
      who, count, first));
}

/// A stepper: what knows the system that it is of.
template <class Source>
concept OnSystem = requires { typename Source::system_type; };

/// The system for one block of trajectories: itself. Of a model see model.hpp.
template <System S>
  requires(!OnSystem<S>)
const S& own_copy(const S& system) {
  return system;
}

/// A stepper for one block of trajectories: of a locked system, a stepper of a copy that it holds; else the
/// one that it was made of, to which it refers.
template <class Stepper>
class own_stepper {
 public:
  explicit own_stepper(const Stepper& shared) : stepper_(&shared) {
    if (!facts_of(shared.system()).is_locked) return;
    held_ = std::make_unique<held>(shared);
    stepper_ = &held_->stepper;
  }

  const Stepper& operator*() const { return *stepper_; }

 private:
  struct held {
    explicit held(const Stepper& of) : system(own_copy(of.system())), stepper(of.with_system(system)) {}

    typename Stepper::system_type system;
    Stepper stepper;
  };

  std::unique_ptr<held> held_;
  const Stepper* stepper_;
};

/// The same of a stepper.
template <OnSystem Stepper>
own_stepper<Stepper> own_copy(const Stepper& stepper) {
  return own_stepper<Stepper>(stepper);
}

/// The driver of ensembles: body(own, first, n) for blocks of at most `width` of the trajectories of this
/// rank, with own_copy() of the system or stepper, and with the exceptions and progress of for_each_block().
/// Trajectories are numbered as in the shard. Ranks are those of the shard, and progress counts the
/// trajectories of all. Collective: what a body throws on one rank is thrown on all.
template <class Source>
void for_each_lane_block(const Source& source, const shard& share, int width, const execution& how,
                         const auto& body) {
  const auto visit = [&](std::int64_t place, int count) {
    body(own_copy(source), share.first() + place, count);
  };
  collectively(share.ranks(), [&] {
    for_each_block(share.count(), width,
                   {.threads = how.threads,
                    .progress = progress_of_share(share.ranks(), share.count(), share.total(), how.progress)},
                   visit);
  });
}

}  // namespace detail

}  // namespace nysalt
