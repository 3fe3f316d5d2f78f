// SPDX-License-Identifier: BSL-1.0
// The trajectories that one rank has of an ensemble.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "nysalt/communicator.hpp"
#include "nysalt/core/tree_sum.hpp"

namespace nysalt {

namespace detail {
/// A term of a sum as the doubles that it is.
inline std::span<double> numbers_in(double& term) { return {&term, 1}; }
template <class Matrix>
std::span<double> numbers_in(Matrix& term) {
  return {term.data(), static_cast<std::size_t>(term.size())};
}
}  // namespace detail

/// Trajectories first() .. first() + count() - 1 of `total`; the others are with other ranks. Ranks have
/// consecutive blocks of 2^k leaves, with the largest k that leaves 32 blocks or more to a rank: then shares
/// differ by one part in 32 at most, and where leaves are fewer, by one leaf. A rank may have none. What
/// refers to it must not outlive the communicator.
class shard {
 public:
  /// The share that this rank has of `total` trajectories. sum() needs leaves as long as the leaves of
  /// tree_sum.
  explicit shard(std::int64_t total, const communicator& ranks = one_rank,
                 std::int64_t leaf = detail::trajectories_of_leaf);

  std::int64_t total() const { return total_; }                    ///< trajectories of all ranks
  std::int64_t first() const { return first_of(ranks_->rank()); }  ///< number of this rank's first
  /// Trajectories of this rank.
  std::int64_t count() const { return first_of(ranks_->rank() + 1) - first(); }
  /// The first trajectory of a rank; total() of rank size().
  std::int64_t first_of(int rank) const;
  const communicator& ranks() const { return *ranks_; }  ///< the ranks that share the trajectories
  /// The trajectories from number `known` on, which become 0, 1, ... and stay with their ranks. A sum over
  /// them is not for this class.
  shard beyond(std::int64_t known) const {
    shard result = *this;
    result.known_ += known;
    result.total_ -= known;
    return result;
  }

  /// tree_sum of the terms of all trajectories, at all ranks: `terms` are the terms of this one, and `zero`
  /// is as large as each. The bits do not depend on the number of ranks. Of 2^k ranks each sends one message
  /// and receives k at most; where shares are no whole subtrees, some seven more. Each is as long as one
  /// term, and rank 0 broadcasts the result.
  ///
  /// Throws std::invalid_argument if the terms are not as many as the trajectories of this rank.
  template <class T>
  T sum(const std::vector<T>& terms, const T& zero) const {
    require_length(std::ssize(terms), count());
    if (ranks_->is_single()) return tree_sum(terms);
    std::vector<T> nodes = detail::sums_of_leaves(std::span<const T>(terms));
    for (int k = 0; k < level_; ++k) detail::add_neighbours(nodes);
    T result = up_the_tree(std::move(nodes), zero);
    ranks_->broadcast(std::as_writable_bytes(detail::numbers_in(result)), 0);
    return result;
  }
  double sum(const std::vector<double>& terms) const {
    return sum(terms, 0.0);
  }  ///< sum of numbers over all trajectories

  /// All-gather of items: each rank has filled in the items of its own trajectories, and all ranks get all.
  /// There are `items` for each group of `group` consecutive trajectories, of which no two ranks share one.
  /// Memory and messages grow with the trajectories: for what is small, and once. Throws
  /// std::invalid_argument if there are not as many items.
  template <class Item>
    requires std::is_trivially_copyable_v<Item>
  void gather(std::vector<Item>& all, std::int64_t items = 1, std::int64_t group = 1) const {
    std::vector<std::size_t> first_of_rank;
    for (int r = 0; r <= ranks_->size(); ++r) {
      first_of_rank.push_back(static_cast<std::size_t>((first_of(r) + group - 1) / group * items));
    }
    require_length(std::ssize(all), static_cast<std::int64_t>(first_of_rank.back()));
    detail::all_gather_items(*ranks_, all, first_of_rank);
  }

 private:
  static constexpr std::int64_t blocks_of_rank = 32;

  static void require_length(std::int64_t length, std::int64_t wanted);
  int rank_of(std::int64_t block) const { return static_cast<int>(block * ranks_->size() / blocks_); }

  /// The nodes of the blocks of this rank become the nodes of the next level, and so on; a node is where its
  /// left half is, so that the root comes to rank 0.
  template <class T>
  T up_the_tree(std::vector<T> nodes, const T& zero) const {
    std::int64_t first = detail::first_of_part(blocks_, ranks_->rank(), ranks_->size());
    std::int64_t all = blocks_;
    for (int level = 0; all > 1; ++level) {
      if (!nodes.empty() && first % 2 == 1) {
        const auto bytes = std::as_bytes(detail::numbers_in(nodes.front()));
        ranks_->send(bytes, rank_of((first - 1) << level));
        nodes.erase(nodes.begin());
        ++first;
      }
      const std::int64_t next = first + static_cast<std::int64_t>(nodes.size());
      if (!nodes.empty() && next % 2 == 1 && next < all) {
        nodes.push_back(zero);
        ranks_->receive(std::as_writable_bytes(detail::numbers_in(nodes.back())), rank_of(next << level));
      }
      detail::add_neighbours(nodes);
      first /= 2;
      all = (all + 1) / 2;
    }
    return nodes.empty() ? zero : std::move(nodes.front());
  }

  std::int64_t total_;
  std::int64_t leaf_;
  std::int64_t known_ = 0;  // trajectories before number 0
  std::int64_t blocks_ = 0;
  int level_ = 0;
  const communicator* ranks_;
};

}  // namespace nysalt
