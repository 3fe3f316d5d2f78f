// SPDX-License-Identifier: BSL-1.0
#include "kept_draws.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace nysalt::program {

kept_draws::kept_draws(std::int64_t chains, std::int64_t draws, std::int64_t coordinates)
    : chains_(static_cast<std::size_t>(chains)),
      draws_(static_cast<std::size_t>(draws)),
      width_(static_cast<std::size_t>(coordinates) + 1),
      numbers_(chains_ * draws_ * width_) {}

void kept_draws::take(const hmc_draw& draw) {
  const auto chain = static_cast<std::size_t>(draw.chain);
  const auto number = static_cast<std::size_t>(draw.number);
  double* at = numbers_.data() + (chain * draws_ + number) * width_;
  *at++ = draw.potential;
  std::copy_n(draw.q.begin(), width_ - 1, at);
}

void kept_draws::gather(const communicator& ranks) {
  const shard share(static_cast<std::int64_t>(chains_), ranks);
  std::vector<std::size_t> first_of_rank;
  for (int r = 0; r <= ranks.size(); ++r)
    first_of_rank.push_back(static_cast<std::size_t>(share.first_of(r)) * draws_ * width_);
  detail::all_gather_items(ranks, numbers_, first_of_rank);
}

std::vector<double> kept_draws::first(std::int64_t draws) const {
  std::vector<double> result;
  for (std::size_t m = 0; m < chains_; ++m) {
    const auto begin = numbers_.begin() + static_cast<std::ptrdiff_t>(m * draws_ * width_);
    result.insert(result.end(), begin, begin + draws * static_cast<std::ptrdiff_t>(width_));
  }
  return result;
}

void kept_draws::restore(std::span<const double> numbers, std::int64_t draws) {
  const std::size_t of_chain = static_cast<std::size_t>(draws) * width_;
  for (std::size_t m = 0; m < chains_; ++m) {
    std::ranges::copy(numbers.subspan(m * of_chain, of_chain),
                      numbers_.begin() + static_cast<std::ptrdiff_t>(m * draws_ * width_));
  }
}

std::string kept_draws::name(std::size_t scalar) {
  return scalar == 0 ? "potential" : fmt::format("q{}", scalar);
}

std::vector<std::vector<double>> kept_draws::chains_of(std::size_t scalar) const {
  std::vector<std::vector<double>> result(chains_, std::vector<double>(draws_));
  for (std::size_t m = 0; m < chains_; ++m) {
    for (std::size_t n = 0; n < draws_; ++n) result[m][n] = numbers_[(m * draws_ + n) * width_ + scalar];
  }
  return result;
}

std::string kept_draws::csv() const {
  std::string text = "chain,draw";
  for (std::size_t k = 0; k < width_; ++k) fmt::format_to(std::back_inserter(text), ",{}", name(k));
  text += '\n';
  for (std::size_t row = 0; row < chains_ * draws_; ++row) {
    fmt::format_to(std::back_inserter(text), "{},{}", row / draws_, row % draws_);
    for (std::size_t k = 0; k < width_; ++k)
      fmt::format_to(std::back_inserter(text), ",{}", numbers_[row * width_ + k]);
    text += '\n';
  }
  return text;
}

summary_of_scalar summary_of(const kept_draws& draws, std::size_t scalar) {
  const auto chains = draws.chains_of(scalar);
  summary_of_scalar result{.name = kept_draws::name(scalar)};
  double count = 0.0;
  for (const auto& chain : chains) {
    for (const double x : chain) {
      count += 1.0;
      result.mean += (x - result.mean) / count;
    }
  }
  for (const auto& chain : chains) {
    for (const double x : chain) result.deviation += (x - result.mean) * (x - result.mean) / count;
  }
  result.deviation = std::sqrt(result.deviation);
  result.effective = effective_draws(chains);
  result.reduction = potential_scale_reduction(chains);
  return result;
}

}  // namespace nysalt::program
