// SPDX-License-Identifier: BSL-1.0

#include "nysalt/kernels/tiled_steps.hpp"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>

#include "../parallel/with_threads.hpp"
#include "nysalt/core/sentence.hpp"

namespace nysalt::detail {

namespace {

// q and p of a tile fill a first-level cache of 32 kB; where a few kicks reach further than that, they may
// take half of a second-level cache of 512 kB.
constexpr Eigen::Index values_of_tile = std::size_t{32} * 1024 / sizeof(double);
constexpr Eigen::Index most_values_of_tile = std::size_t{256} * 1024 / sizeof(double);
// Kicks of a site that take as long as moving the site to the cache and back, roughly; measured within a
// factor of two on the processors of docs/performance.md, and the best number of kicks goes with the square
// root.
constexpr double kicks_of_a_move = 8.0;
// The halo, which is computed twice, is at most the 16th part of a tile. Where a kick takes longer than on a
// chain, moving costs less beside it, and more of the tile would be lost than moving gains.
constexpr Eigen::Index most_overlap = 16;
// Beyond this, moving is less than a tenth of the work.
constexpr Eigen::Index most_kicks = 64;
// A sweep that makes fewer of them costs more on one thread than it gains. Measured on square lattices.
constexpr Eigen::Index many_kicks = 8;
// Between two observations: with fewer, a chain in tiles takes longer than one in a loop over all sites.
constexpr std::int64_t enough_kicks = 4;
// Two threads with less than this each lose more by meeting than they gain. Measured on chains and lattices.
constexpr Eigen::Index values_of_thread = 4096;
// Where the window is a single tile without a halo: so that a sweep is long beside its call.
constexpr int kicks_without_halo = 4096;

/// From `components` numbers a site to a column for each component.
void to_columns(std::span<const double> values, Eigen::Index components, const columns& to,
                Eigen::Index first) {
  const auto sites = static_cast<Eigen::Index>(values.size()) / components;
  for (Eigen::Index c = 0; c < components; ++c) {
    double* const column = &to(c, first);
    const double* const from = values.data() + c;
    if (components == 1) {
      std::copy_n(from, sites, column);
    } else if (components == 2) {  // a stride that is known vectorises
      for (Eigen::Index i = 0; i < sites; ++i) column[i] = from[2 * i];
    } else {
      for (Eigen::Index i = 0; i < sites; ++i) column[i] = from[components * i];
    }
  }
}

/// The other way.
void from_columns(const columns& from, Eigen::Index first, Eigen::Index components,
                  std::span<double> values) {
  const auto sites = static_cast<Eigen::Index>(values.size()) / components;
  if (components == 2) {  // both in one pass
    const double* const first_column = &from(0, first);
    const double* const second_column = &from(1, first);
    for (Eigen::Index i = 0; i < sites; ++i) {
      values[static_cast<std::size_t>(2 * i)] = first_column[i];
      values[static_cast<std::size_t>(2 * i + 1)] = second_column[i];
    }
    return;
  }
  for (Eigen::Index c = 0; c < components; ++c) {
    const double* const column = &from(c, first);
    double* const to = values.data() + c;
    for (Eigen::Index i = 0; i < sites; ++i) to[components * i] = column[i];
  }
}

/// `count` numbers from `begin` on.
template <class T>
std::span<T> numbers(T* begin, Eigen::Index count) {
  return {begin, static_cast<std::size_t>(count)};
}

/// Sites of a tile, as far as the cache decides.
Eigen::Index sites_that_fit(const site_layout& layout) {
  const Eigen::Index values_of_site = 2 * layout.components;
  return std::clamp(64 * layout.reach, values_of_tile / values_of_site, most_values_of_tile / values_of_site);
}

}  // namespace

/// The threads, and a buffer for each.
struct site_window::workers {
  workers(int threads, Eigen::Index sites, Eigen::Index components)
      : stride(sites), buffers(static_cast<std::size_t>(threads)) {
    for (auto& buffer : buffers) buffer.resize(static_cast<std::size_t>(3 * components * sites));
    if (threads == 1) return;
    with_threads(threads, [&] {
      // As many as were asked for, also beyond the number of cores.
      allowed.emplace(oneapi::tbb::global_control::max_allowed_parallelism,
                      static_cast<std::size_t>(threads));
      arena.emplace(threads);
    });
  }

  /// work(item, buffer) for each item.
  void share(std::int64_t items, const auto& work) {
    if (!arena) {
      for (std::int64_t item = 0; item < items; ++item) work(item, buffers.front());
      return;
    }
    const auto all_items = [&] {
      using oneapi::tbb::this_task_arena::current_thread_index;
      const auto in_buffer = [&](std::int64_t item) {
        work(item, buffers[static_cast<std::size_t>(current_thread_index())]);
      };
      // Each thread gets the same tiles in every sweep, whose values are in the cache of that thread's core.
      oneapi::tbb::parallel_for(std::int64_t{0}, items, in_buffer, oneapi::tbb::static_partitioner());
    };
    with_threads(static_cast<int>(buffers.size()), [&] { arena->execute(all_items); });
  }

  Eigen::Index stride;
  std::vector<std::vector<double>> buffers;
  std::optional<oneapi::tbb::global_control> allowed;
  std::optional<oneapi::tbb::task_arena> arena;
};

site_window::site_window(const site_kernels& system, Eigen::Index first, Eigen::Index count, int threads,
                         std::int64_t kicks_at_once)
    : system_(&system), layout_(system.layout()), first_(first) {
  const Eigen::Index row = layout_.sites_of_row;
  const Eigen::Index rows = count / row;
  const Eigen::Index reach = layout_.reach;
  const Eigen::Index rows_of_tile = std::max<Eigen::Index>(sites_that_fit(layout_) / row, 1);
  const Eigen::Index rows_reached = (reach - 1) / row + 1;  // a halo comes from one neighbour
  const Eigen::Index for_threads = std::min<Eigen::Index>(threads, rows / (8 * rows_reached));
  const Eigen::Index tiles = std::clamp<Eigen::Index>(std::max((rows - 1) / rows_of_tile + 1, for_threads), 1,
                                                      std::max<Eigen::Index>(rows / rows_reached, 1));
  for (Eigen::Index t = 0; t <= tiles; ++t) tiles_.push_back(first + row * (rows * t / tiles));
  // Of n kicks in a sweep, each site is moved once and a tile of s sites computes n reach more than its own:
  // a kick of a site costs kicks_of_a_move/n + n reach/s beside itself, least at the square root.
  const Eigen::Index reaches = std::max<Eigen::Index>(row * (rows / tiles) / reach, 1);
  const auto best = static_cast<Eigen::Index>(std::sqrt(kicks_of_a_move * static_cast<double>(reaches)));
  kicks_ = static_cast<int>(std::clamp<Eigen::Index>(std::min(best, reaches / most_overlap), 1, most_kicks));
  const bool has_halo = has_neighbour(side::left) || has_neighbour(side::right) || tiles > 1;
  if (!has_halo) kicks_ = kicks_without_halo;
  kicks_ = static_cast<int>(std::clamp<std::int64_t>(kicks_at_once, 1, kicks_));
  edges_.resize(static_cast<std::size_t>(2 * (tiles - 1)) * halo_size(kicks_));
  const Eigen::Index halos = has_halo ? 2 * reach * kicks_ : 0;
  const Eigen::Index most_sites = std::max(row * ((rows - 1) / tiles + 1), sites_of_leaf(layout_));
  workers_ = std::make_unique<workers>(threads, most_sites + halos, layout_.components);
}

site_window::~site_window() = default;

std::size_t site_window::halo_size(int kicks) const {
  return static_cast<std::size_t>(2 * layout_.components * layout_.reach * kicks);
}

bool site_window::has_neighbour(side at) const {
  if (layout_.is_periodic) return true;
  return at == side::left ? first_ > 0 : tiles_.back() < layout_.sites;
}

void site_window::copy_edge(side at, int kicks, const double* q, const double* p,
                            std::span<double> halo) const {
  const std::size_t half = halo_size(kicks) / 2;
  const auto all = static_cast<std::size_t>(layout_.components * (tiles_.back() - first_));
  const std::size_t from = at == side::left ? 0 : all - half;
  std::ranges::copy(std::span(q + from, half), halo.begin());
  std::ranges::copy(std::span(p + from, half), halo.subspan(half).begin());
}

void site_window::sweep(std::span<const tile_letter> letters, double* q, double* p, double* f,
                        std::span<const double> left_halo, std::span<const double> right_halo) {
  const auto kicks = static_cast<int>(std::ranges::count_if(letters, &tile_letter::is_kick));
  const bool keeps_force = std::ranges::any_of(letters, &tile_letter::keeps_force);
  const Eigen::Index components = layout_.components;
  const Eigen::Index width = layout_.reach * kicks;
  const std::size_t size = halo_size(kicks);
  const auto half = static_cast<Eigen::Index>(size / 2);
  const auto tiles = static_cast<std::int64_t>(tiles_.size()) - 1;
  const auto site = [&](std::int64_t boundary) { return tiles_[static_cast<std::size_t>(boundary)]; };
  const auto values_before = [&](std::int64_t boundary) { return components * (site(boundary) - first_); };
  const auto edge = [&](std::int64_t inner_boundary, side at) {
    const auto number = static_cast<std::size_t>(2 * (inner_boundary - 1) + (at == side::right ? 1 : 0));
    return std::span(edges_).subspan(number * size, size);
  };
  workers_->share(tiles - 1, [&](std::int64_t i, auto&) {
    const Eigen::Index at = values_before(i + 1);
    const auto left = edge(i + 1, side::left);
    const auto right = edge(i + 1, side::right);
    std::copy_n(q + at - half, half, left.data());
    std::copy_n(p + at - half, half, left.data() + half);
    std::copy_n(q + at, half, right.data());
    std::copy_n(p + at, half, right.data() + half);
  });
  workers_->share(tiles, [&](std::int64_t t, std::vector<double>& buffer) {
    const Eigen::Index begin = site(t);
    const Eigen::Index end = site(t + 1);
    const Eigen::Index at = values_before(t);
    const Eigen::Index own = components * (end - begin);
    const std::span<const double> left = t == 0 ? left_halo : edge(t, side::left);
    const std::span<const double> right = t + 1 == tiles ? right_halo : edge(t + 1, side::right);
    const Eigen::Index first = begin - (left.empty() ? 0 : width);
    const Eigen::Index last = end + (right.empty() ? 0 : width);
    const auto part = [&](Eigen::Index number) {
      return columns(buffer.data() + number * components * (last - first), first, last - first);
    };
    const tile x{part(0), part(1), part(2), first, last, !left.empty(), !right.empty()};
    if (!left.empty()) {
      to_columns(left.first(size / 2), components, x.q, first);
      to_columns(left.last(size / 2), components, x.p, first);
    }
    to_columns(numbers<const double>(q + at, own), components, x.q, begin);
    to_columns(numbers<const double>(p + at, own), components, x.p, begin);
    if (!right.empty()) {
      to_columns(right.first(size / 2), components, x.q, end);
      to_columns(right.last(size / 2), components, x.p, end);
    }
    system_->advance(x, letters);
    from_columns(x.q, begin, components, numbers(q + at, own));
    from_columns(x.p, begin, components, numbers(p + at, own));
    if (keeps_force) from_columns(x.f, begin, components, numbers(f + at, own));
  });
}

std::vector<double> site_window::energies_of_leaves(const double* q, const double* p,
                                                    std::span<const double> left_halo,
                                                    std::span<const double> right_halo) {
  const Eigen::Index components = layout_.components;
  const Eigen::Index leaf = sites_of_leaf(layout_);
  const Eigen::Index end_of_all = tiles_.back();
  std::vector<double> result(static_cast<std::size_t>((end_of_all - first_ - 1) / leaf + 1));
  workers_->share(std::ssize(result), [&](std::int64_t number, std::vector<double>& buffer) {
    const Eigen::Index begin = first_ + number * leaf;
    const Eigen::Index end = std::min(begin + leaf, end_of_all);
    const bool has_left = begin > first_ || has_neighbour(side::left);
    const bool has_right = end < end_of_all || has_neighbour(side::right);
    const Eigen::Index first = begin - (has_left ? layout_.reach : 0);
    const Eigen::Index last = end + (has_right ? layout_.reach : 0);
    const auto part = [&](Eigen::Index of) {
      return columns(buffer.data() + of * components * (last - first), first, last - first);
    };
    const tile x{part(0), part(1), part(2), first, last, has_left, has_right};
    // Sites from - to, which may be in the window or, all of them, in a halo.
    const auto fill = [&](Eigen::Index from, Eigen::Index to) {
      if (from == to) return;
      const Eigen::Index count = components * (to - from);
      const Eigen::Index at = components * (from - first_);
      const auto half = static_cast<std::ptrdiff_t>(halo_size(1) / 2);
      const bool is_left = from < first_;
      const bool is_right = from >= end_of_all;
      const Eigen::Index in_halo =
          is_left ? components * (from - first_ + layout_.reach) : components * (from - end_of_all);
      const double* const halo = (is_left ? left_halo : right_halo).data();
      const bool is_in_halo = is_left || is_right;
      to_columns(numbers(is_in_halo ? halo + in_halo : q + at, count), components, x.q, from);
      to_columns(numbers(is_in_halo ? halo + half + in_halo : p + at, count), components, x.p, from);
    };
    const Eigen::Index inner_first = std::max(first, first_);
    const Eigen::Index inner_last = std::min(last, end_of_all);
    fill(first, inner_first);
    fill(inner_first, inner_last);
    fill(inner_last, last);
    result[static_cast<std::size_t>(number)] = system_->energy(x, begin, end);
  });
  return result;
}

site_layout required(const site_layout& layout, Eigen::Index size) {
  if (layout.components < 1 || layout.sites < 1 || layout.components * layout.sites != size) {
    throw std::invalid_argument(
        sentence("LocalSystem: components * sites() must be the number of coordinates, {}, got {} * {}", size,
                 layout.components, layout.sites));
  }
  const Eigen::Index row = layout.sites_of_row;
  if (layout.reach < 0 || row < 1 || layout.sites % row != 0 || layout.reach % row != 0) {
    throw std::invalid_argument(
        sentence("LocalSystem: reach() must not be negative, and sites() and reach() must be multiples of "
                 "sites_of_row(), got {}, {} and {}",
                 layout.reach, layout.sites, row));
  }
  site_layout result = layout;
  result.reach = std::max(layout.reach, row);
  return result;
}

int threads_in_tiles(const site_layout& layout, int threads, std::int64_t kicks) {
  constexpr Eigen::Index few = 64;
  const Eigen::Index values = layout.components * layout.sites;
  if (values < few || layout.sites < 4 * layout.reach) return 0;
  const int useful = static_cast<int>(std::clamp<Eigen::Index>(values / values_of_thread, 1, threads));
  if (useful > 1) return useful;
  if (kicks < enough_kicks) return 0;
  // One thread gains where a sweep makes many kicks, or nothing is computed twice.
  const bool is_one_tile = !layout.is_periodic && layout.sites <= sites_that_fit(layout);
  return is_one_tile || sites_that_fit(layout) >= most_overlap * many_kicks * layout.reach ? 1 : 0;
}

Eigen::Index sites_of_leaf(const site_layout& layout) {
  constexpr Eigen::Index about = 1024;
  return layout.sites_of_row * ((about - 1) / layout.sites_of_row + 1);
}

std::span<const tile_letter> letters_in_portions::next(int kicks) {
  portion_.clear();
  const std::size_t letters = 2 * program_->pairs.size();
  int taken = 0;
  for (; step_ < steps_; ++step_, letter_ = 0) {
    for (; letter_ < letters; ++letter_) {
      const bool is_kick = program_->begins_with_kick == (letter_ % 2 == 0);
      if (is_kick && taken == kicks) return portion_;
      if (is_kick) ++taken;
      const bool is_last = step_ + 1 == steps_ && letter_ + 1 == letters;
      portion_.push_back({.coefficient = program_->pairs[letter_ / 2][letter_ % 2],
                          .is_kick = is_kick,
                          .keeps_force = is_last && program_->keeps_last_force});
    }
  }
  return portion_;
}

tiled_steps::tiled_steps(const site_kernels& system, int threads, std::int64_t kicks)
    : layout_(system.layout()), window_(system, 0, layout_.sites, threads, kicks) {}

void tiled_steps::advance(double* q, double* p, double* f, const step_program<double>& program,
                          std::int64_t steps) {
  letters_in_portions letters(program, steps);
  const int most = window_.kicks_of_sweep();
  for (auto portion = letters.next(most); !portion.empty(); portion = letters.next(most)) {
    if (layout_.is_periodic) {  // the last sites are to the left of the first, and the first to the right
      const auto kicks = static_cast<int>(std::ranges::count_if(portion, &tile_letter::is_kick));
      left_halo_.resize(window_.halo_size(kicks));
      right_halo_.resize(window_.halo_size(kicks));
      window_.copy_edge(side::right, kicks, q, p, left_halo_);
      window_.copy_edge(side::left, kicks, q, p, right_halo_);
    }
    window_.sweep(portion, q, p, f, left_halo_, right_halo_);
  }
}

}  // namespace nysalt::detail
