// SPDX-License-Identifier: BSL-1.0
// Families made of other families, and of words.
#include "nysalt/family.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "nysalt/core/sentence.hpp"

namespace nysalt {

namespace {

Eigen::MatrixXd thermostatted_jacobian(const family& plain, placement where, const Eigen::VectorXd& theta) {
  using D = dual<double, 1>;
  const auto c = plain.coefficients(theta);
  const Eigen::MatrixXd slopes = plain.jacobian(theta);
  Eigen::MatrixXd result;
  for (Eigen::Index k = 0; k < slopes.cols(); ++k) {
    std::vector<D> lifted(c.begin(), c.end());
    for (std::size_t i = 0; i < c.size(); ++i) {
      lifted[i].derivative[0] = slopes(static_cast<Eigen::Index>(i), k);
    }
    const auto placed = detail::thermostatted_coefficients(plain.letters, where, lifted);
    result.conservativeResize(static_cast<Eigen::Index>(placed.size()), slopes.cols());
    for (std::size_t i = 0; i < placed.size(); ++i) {
      result(static_cast<Eigen::Index>(i), k) = placed[i].derivative[0];
    }
  }
  return result;
}

}  // namespace

family::family(std::string method_name, const word& all, std::vector<double> coefficients)
    : name(std::move(method_name)),
      starts({{name, Eigen::VectorXd()}}),
      order(0),
      symmetric(false),
      requires_quadratic_kinetic(false),
      letters(all),
      coefficients_([coefficients](const Eigen::VectorXd&) { return coefficients; }),
      jacobian_([count = static_cast<Eigen::Index>(coefficients.size())](const Eigen::VectorXd&) {
        return Eigen::MatrixXd(count, 0);
      }) {}

void family::contain(family inner) {
  const Eigen::VectorXd somewhere = inner.starts.front().theta;
  const Eigen::Index count = parameters();
  const bool is_smaller = inner.letters.letters() == letters.letters() && inner.parameters() < count &&
                          count <= std::ssize(inner.coefficients(somewhere));
  detail::contained_family result{std::move(inner), {}, {}};
  const auto is_member = [&](const Eigen::VectorXd& theta) {
    constexpr double rounding = 1e-12;  // sums of some coefficients of order one
    const auto ours = coefficients(result.embed(theta));
    const auto theirs = result.family.coefficients(theta);
    return std::ranges::equal(ours, theirs, [](double x, double y) { return std::abs(x - y) <= rounding; });
  };
  if (is_smaller) {
    const auto all = result.family.coefficients(somewhere);
    result.slopes = result.family.jacobian(somewhere).topRows(count);
    result.origin = Eigen::Map<const Eigen::VectorXd>(all.data(), count) - result.slopes * somewhere;
  }
  constexpr double elsewhere = 0.9;
  if (!is_smaller || !is_member(somewhere) || !is_member(elsewhere * somewhere)) {
    throw std::logic_error(sentence(
        "{}: members of the contained family must be members, and the first coefficients of the word the "
        "parameters, got {} of the word {} in {}",
        name, result.family.name, result.family.letters.letters(), letters.letters()));
  }
  contained = std::make_shared<const detail::contained_family>(std::move(result));
}

bool family::is_defined(const Eigen::VectorXd& theta) const {
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    if (ranges[k].open && !ranges[k].contains(theta[static_cast<Eigen::Index>(k)])) return false;
  }
  return true;
}

bool family::is_in_range(const Eigen::VectorXd& theta) const {
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    if (!ranges[k].contains(theta[static_cast<Eigen::Index>(k)])) return false;
  }
  return true;
}

family thermostatted(const family& plain, placement where) {
  family result = plain;
  result.letters = thermostatted(plain.letters, where);
  result.order = detail::thermostatted_order(where, plain.order, plain.symmetric);
  result.symmetric = where != placement::end && plain.symmetric;
  result.coefficients_ = [plain, where](const Eigen::VectorXd& theta) {
    return detail::thermostatted_coefficients(plain.letters, where, plain.coefficients(theta));
  };
  result.jacobian_ = [plain, where](const Eigen::VectorXd& theta) {
    return thermostatted_jacobian(plain, where, theta);
  };
  if (plain.contained) {
    const auto& [inner, slopes, origin] = *plain.contained;
    result.contained = std::make_shared<const detail::contained_family>(
        detail::contained_family{thermostatted(inner, where), slopes, origin});
  }
  return result;
}

namespace {

/// The coefficients of the processor from its parameters: of A and of B all but the last are parameters, in
/// the order of the word, and the last of each is what makes their sum zero.
void append_processor(std::vector<double>& coefficients, const Eigen::VectorXd& theta, Eigen::Index first,
                      Eigen::Index pairs) {
  double sum_of_a = 0.0;
  double sum_of_b = 0.0;
  for (Eigen::Index k = 0; k + 1 < pairs; ++k) {
    const double b = theta[first + 2 * k];
    const double a = theta[first + 2 * k + 1];
    coefficients.insert(coefficients.end(), {b, a});
    sum_of_b += b;
    sum_of_a += a;
  }
  coefficients.insert(coefficients.end(), {-sum_of_b, -sum_of_a});
}

Eigen::VectorXd with_identity(const Eigen::VectorXd& theta, Eigen::Index further) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(theta.size() + further);
  result.head(theta.size()) = theta;
  return result;
}

}  // namespace

family processed(const family& kernel, int pairs) {
  if (pairs < 2 || pairs > detail::most_processor_pairs) {
    throw std::invalid_argument(sentence("{}: a processor must have from 2 to {} pairs of letters, got {}",
                                         kernel.name, detail::most_processor_pairs, pairs));
  }
  if (!kernel.symmetric) {
    throw std::invalid_argument(
        sentence("{}: the kernel of a processed word must be symmetric, got {}; take another family",
                 kernel.name, kernel.letters.letters()));
  }
  family result = kernel;
  const Eigen::Index known = kernel.parameters();
  const Eigen::Index further = Eigen::Index{2} * (pairs - 1);
  const Eigen::Index all = known + further;
  result.contained = std::make_shared<const detail::contained_family>(
      detail::contained_family{kernel, Eigen::MatrixXd::Identity(all, known), Eigen::VectorXd::Zero(all)});
  std::string letters = kernel.letters.letters() + word::processor_mark;
  for (int k = 0; k < pairs; ++k) letters += "BA";
  result.letters = word(letters);
  result.name += sentence("+p{}", pairs);
  result.order = 2;
  for (Eigen::Index k = 0; k < further; ++k) {
    result.parameter_names.push_back(sentence("p{}", k + 1));
    result.ranges.push_back({-1.0, 1.0, false});
  }
  for (auto& start : result.starts) start.theta = with_identity(start.theta, further);
  if (result.most_stable_member)
    result.most_stable_member = with_identity(*result.most_stable_member, further);
  result.coefficients_ = [kernel, known, pairs](const Eigen::VectorXd& theta) {
    auto all = kernel.coefficients(theta.head(known));
    append_processor(all, theta, known, pairs);
    return all;
  };
  result.jacobian_ = [kernel, known, further](const Eigen::VectorXd& theta) {
    const Eigen::MatrixXd of_kernel = kernel.jacobian(theta.head(known));
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(of_kernel.rows() + further + 2, known + further);
    all.topLeftCorner(of_kernel.rows(), known) = of_kernel;
    for (Eigen::Index k = 0; k < further; ++k) {
      all(of_kernel.rows() + k, known + k) = 1.0;
      all(of_kernel.rows() + further + k % 2, known + k) = -1.0;
    }
    return all;
  };
  return result;
}

namespace {

/// Slots that hold one coefficient: of a letter left of the middle and of the one that mirrors it.
struct mirrored_slots {
  std::size_t first;  // equal where the letter is in the middle
  std::size_t last;
  char part;
  Eigen::Index parameter = -1;  // -1: what makes the sum of the part one

  double slots() const { return first == last ? 1.0 : 2.0; }
};

std::vector<mirrored_slots> mirrored_slots_of(const nysalt::word& word, const std::string& times) {
  std::vector<mirrored_slots> result;
  for (std::size_t i = 0; 2 * i < word.length; ++i) {
    const std::size_t j = word.length - 1 - i;
    for (std::size_t k = 0; k < word.slots_of(i); ++k) {
      const std::size_t first = word.first_slot(i) + k;
      result.push_back({first, word.first_slot(j) + k, times[first]});
    }
  }
  return result;
}

/// Coefficients of a part in a word of equal steps: each letter has half of the time to the letter of the
/// same part before it, around the end of the step, and half of that to the one behind it. Time passes
/// between two of them where the part acts that lies between most of them.
void put_equal_steps(const nysalt::word& word, const std::string& times, char part,
                     std::vector<double>& coefficients) {
  std::vector<std::size_t> letters;  // where the part acts, and in which slot
  std::vector<std::size_t> slots;
  for (std::size_t i = 0; i < word.length; ++i) {
    for (std::size_t k = word.first_slot(i); k < word.first_slot(i) + word.slots_of(i); ++k) {
      if (times[k] != part) continue;
      letters.push_back(i);
      slots.push_back(k);
    }
  }
  const std::size_t count = letters.size();
  std::vector<std::string> between(count);  // parts between occurrence n and the next
  std::string others;
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t end = n + 1 < count ? letters[n + 1] : letters[0] + word.length;
    for (std::size_t i = letters[n] + 1; i < end; ++i) {
      const std::size_t letter = i < word.length ? i : i - word.length;
      between[n] += times.substr(word.first_slot(letter), word.slots_of(letter));
    }
    others += between[n];
  }
  const auto gaps_with = [&](char other) {
    return std::ranges::count_if(
        between, [&](const std::string& all) { return all.find(other) != std::string::npos; });
  };
  char clock = part;
  for (const char other : others) {
    if (clock == part || gaps_with(other) > gaps_with(clock)) clock = other;
  }
  double sum = 0.0;
  for (std::size_t n = 0; n < count; ++n) {
    const auto passes = [&](std::size_t gap) {
      return clock == part || between[gap].find(clock) != std::string::npos ? 0.5 : 0.0;
    };
    coefficients[slots[n]] = passes((n + count - 1) % count) + passes(n);
    sum += coefficients[slots[n]];
  }
  for (const std::size_t slot : slots) coefficients[slot] /= sum;
}

}  // namespace

family symmetric_word(std::string name, const nysalt::word& word, const std::string& times) {
  const std::string letters = word.letters();
  const auto refuse = [&](const char* condition, const std::string& got, const char* remedy) {
    throw std::invalid_argument(sentence("{}: the word must {}, got {}; {}", name, condition, got, remedy));
  };
  if (word.is_processed()) refuse("have no processor", letters, "leave out what follows |");
  if (!std::equal(letters.begin(), letters.end(), letters.rbegin()))
    refuse("read the same from both ends", letters, "mirror its letters");
  if (std::ranges::adjacent_find(letters) != letters.end())
    refuse("not have two equal neighbours", letters, "join them");
  if (times.size() != word.slots) {
    refuse("have a part of H for each coefficient",
           sentence("{} for the {} of {}", times.size(), word.slots, letters), "name a part for each");
  }
  std::vector<mirrored_slots> all = mirrored_slots_of(word, times);
  std::vector<double> equal_steps(word.slots);
  std::vector<double> start;
  family result(std::move(name), word, {});
  for (std::size_t n = 0; n < all.size(); ++n) {
    const auto is_of_part = [&](const mirrored_slots& one) { return one.part == all[n].part; };
    const auto before = static_cast<std::size_t>(
        std::count_if(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(n), is_of_part));
    if (before == 0) put_equal_steps(word, times, all[n].part, equal_steps);
    if (std::none_of(all.begin() + static_cast<std::ptrdiff_t>(n) + 1, all.end(), is_of_part)) continue;
    all[n].parameter = result.parameters();
    result.parameter_names.push_back(sentence("{}{}", all[n].part, before + 1));
    result.ranges.push_back({-detail::farthest_parameter, detail::farthest_parameter, false});
    start.push_back(equal_steps[all[n].first]);
  }
  const Eigen::VectorXd theta = Eigen::Map<const Eigen::VectorXd>(start.data(), std::ssize(start));
  result.starts = {{"start", theta}};
  if (theta.size() > 0) result.most_stable_member = theta;
  result.order = 2;
  result.symmetric = true;
  result.requires_quadratic_kinetic = word.rotates();
  result.coefficients_ = [all, slots = word.slots](const Eigen::VectorXd& given) {
    std::vector<double> c(slots);
    for (const auto& one : all) {
      double value = 1.0;
      if (one.parameter >= 0) {
        value = given[one.parameter];
      } else {
        for (const auto& other : all) {
          if (other.part == one.part && other.parameter >= 0) value -= other.slots() * given[other.parameter];
        }
        value /= one.slots();
      }
      c[one.first] = c[one.last] = value;
    }
    return c;
  };
  result.jacobian_ = [all, slots = word.slots, count = theta.size()](const Eigen::VectorXd&) {
    Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(slots), count);
    for (const auto& one : all) {
      for (const std::size_t slot : {one.first, one.last}) {
        const auto row = static_cast<Eigen::Index>(slot);
        if (one.parameter >= 0) {
          slopes(row, one.parameter) = 1.0;
          continue;
        }
        for (const auto& other : all) {
          if (other.part == one.part && other.parameter >= 0)
            slopes(row, other.parameter) = -other.slots() / one.slots();
        }
      }
    }
    return slopes;
  };
  return result;
}

method member(const family& family, const std::vector<double>& theta) {
  if (std::ssize(theta) != family.parameters()) {
    throw std::invalid_argument(sentence("{}: theta must have {} parameters, got {}", family.name,
                                         family.parameters(), theta.size()));
  }
  const Eigen::VectorXd column = Eigen::Map<const Eigen::VectorXd>(theta.data(), std::ssize(theta));
  detail::require_in_range(family, column);
  return {family.name,
          family.letters,
          family.coefficients(column),
          {family.order, family.symmetric, family.requires_quadratic_kinetic}};
}

void detail::require_in_range(const family& family, const Eigen::VectorXd& theta) {
  for (std::size_t k = 0; k < family.ranges.size(); ++k) {
    detail::require_in_range(family.name, family.parameter_names[k], family.ranges[k],
                             theta[static_cast<Eigen::Index>(k)]);
  }
}

}  // namespace nysalt
