// SPDX-License-Identifier: BSL-1.0
#include "known_word.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catalogue.hpp"

namespace nysalt::program {

namespace {

constexpr double same = 1e-6;

/// One letter: c, and of a gradient kick the coefficient of its gradient part, of a displaced kick that of
/// its displacement. Of a letter of one's own all coefficients are times, and c and the gradient are 0.
struct letter {
  char name;
  double c;
  double gradient;
  std::vector<double> times{};
  bool additive = true;

  bool has_times(double zero) const {
    return std::ranges::any_of(times, [=](double x) { return std::abs(x) > zero; });
  }
};

bool is_kick(char name) { return name == 'B' || name == 'G'; }
bool is_soft_kick(char name) { return name == 'S' || name == 'H'; }

/// All that kicks of one force do is added up, as q does not move between them.
bool act_as_one(const letter& a, const letter& b) {
  if (!a.times.empty() || !b.times.empty()) return a.name == b.name && a.additive;
  if (a.name == 'D' && b.name == 'D') return a.gradient == b.gradient;
  return a.name == b.name || (is_kick(a.name) && is_kick(b.name)) ||
         (is_soft_kick(a.name) && is_soft_kick(b.name));
}

/// Coefficients of at most `zero` count as zero.
std::vector<letter> merged(const std::vector<letter>& all, double zero) {
  std::vector<letter> result;
  for (letter one : all) {
    if (!result.empty() && act_as_one(result.back(), one)) {
      one.c += result.back().c;
      if (one.name != 'D') one.gradient += result.back().gradient;
      for (std::size_t k = 0; k < one.times.size(); ++k) one.times[k] += result.back().times[k];
      result.pop_back();
    }
    const bool has_gradient = one.name != 'D' && std::abs(one.gradient) > zero;
    if (is_kick(one.name)) one.name = has_gradient ? 'G' : 'B';
    if (is_soft_kick(one.name)) one.name = has_gradient ? 'H' : 'S';
    if (std::abs(one.c) > zero || has_gradient || one.has_times(zero)) result.push_back(one);
  }
  return result;
}

std::vector<letter> letters_of(const nysalt::word& word, const std::vector<double>& coefficients) {
  std::vector<letter> result;
  for (std::size_t i = 0; i < word.length; ++i) {
    const char name = word.letters()[i];
    const std::size_t slot = word.first_slot(i);
    if (const auto* own = word.own_letter(name)) {
      const auto first = coefficients.begin() + static_cast<std::ptrdiff_t>(slot);
      const auto count = static_cast<std::ptrdiff_t>(word.slots_of(i));
      result.push_back({name, 0.0, 0.0, {first, first + count}, own->additive});
      continue;
    }
    letter one{name, coefficients[slot], word.slots_of(i) > 1 ? coefficients[slot + 1] : 0.0};
    if (name == 'D' && one.gradient == 0.0) one.name = 'B';
    result.push_back(one);
  }
  return result;
}

/// n steps of h/n: times go with h, gradient parts with h^3, displacements with h^2.
std::vector<letter> repeated(const std::vector<letter>& one_step, int n) {
  std::vector<letter> result;
  for (int k = 0; k < n; ++k) {
    for (letter one : one_step) {
      one.c /= n;
      one.gradient /= std::pow(n, one.name == 'D' ? 2.0 : 3.0);
      for (double& time : one.times) time /= n;
      result.push_back(one);
    }
  }
  return merged(result, 0.0);
}

bool are_same(const std::vector<letter>& a, const std::vector<letter>& b) {
  return std::ranges::equal(a, b, [](const letter& x, const letter& y) {
    const auto are_near = [](double u, double v) { return std::abs(u - v) < same; };
    return x.name == y.name && are_near(x.c, y.c) && are_near(x.gradient, y.gradient) &&
           std::ranges::equal(x.times, y.times, are_near);
  });
}

/// Whether the processor is the identity.
bool is_trivial(const method& method) {
  const auto c = method.coefficients();
  return std::all_of(c.begin() + static_cast<std::ptrdiff_t>(method.letters().kernel_slots), c.end(),
                     [](double x) { return std::abs(x) < same; });
}

/// Of processed words, of which many do the same.
bool are_same_to_the_letter(const method& a, const method& b) {
  return a.letters().letters() == b.letters().letters() &&
         std::ranges::equal(a.coefficients(), b.coefficients(),
                            [](double x, double y) { return std::abs(x - y) < same; });
}

}  // namespace

std::optional<std::string> known_as(const method& method, std::span<const nysalt::method> known) {
  if (method.letters().is_processed() && !is_trivial(method)) {
    for (const nysalt::method& other : known) {
      if (are_same_to_the_letter(method, other)) return other.name();
    }
    return std::nullopt;
  }
  const auto letters = merged(letters_of(method.letters(), method.coefficients()), same);
  for (const nysalt::method& other : known) {
    if (other.letters().is_processed()) continue;
    const auto one_step = merged(letters_of(other.letters(), other.coefficients()), same);
    for (int n = 1;; ++n) {
      const auto steps = repeated(one_step, n);
      if (steps.size() > letters.size()) break;
      if (are_same(letters, steps))
        return n == 1 ? other.name() : fmt::format("{}, {} steps in one", other.name(), n);
      if (one_step.size() < 2) break;  // the word does not grow
    }
  }
  return std::nullopt;
}

std::optional<std::string> known_as(const std::string& family, const std::vector<double>& theta,
                                    std::span<const method> further,
                                    const std::vector<letter_facts>& of_system) {
  const nysalt::family named_family = family_named(family, of_system);
  const auto member = [&](const std::string& name, const Eigen::VectorXd& at) {
    return method(name, named_family.letters, named_family.coefficients(at),
                  {named_family.order, named_family.symmetric, named_family.requires_quadratic_kinetic});
  };
  std::vector<method> known;
  for (const auto& classical : classical_methods()) known.push_back(classical.method);
  known.insert(known.end(), further.begin(), further.end());
  for (const auto& [name, at] : named_family.starts) {
    if (name == "further start") continue;
    const bool is_own = name == "start";
    known.push_back(
        member(fmt::format("{} {} {}", is_own ? "the start" : name, is_own ? "of" : "in", family), at));
  }
  if (named_family.most_stable_member)
    known.push_back(member("the most stable member of " + family, *named_family.most_stable_member));
  const Eigen::VectorXd at = Eigen::Map<const Eigen::VectorXd>(theta.data(), std::ssize(theta));
  return known_as(member(family, at), known);
}

}  // namespace nysalt::program
