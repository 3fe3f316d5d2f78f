// SPDX-License-Identifier: BSL-1.0
#include <algorithm>
#include <string>

#include "laws.hpp"
#include "models.hpp"
#include "nysalt/families/composition.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/s_aia.hpp"

namespace nysalt::test {

namespace {

bool has(const std::string& letters, char letter) { return letters.find(letter) != std::string::npos; }

method random_member(const family& family, draws& random) {
  return {family.name,
          family.letters,
          family.coefficients(random_theta(family, random)),
          {family.order, family.symmetric, family.requires_quadratic_kinetic}};
}

/// Any word, with a whole step shared equally by the letters of each kind.
method shared_equally(const std::string& letters) {
  std::vector<double> c;
  for (const char letter : letters) {
    c.push_back(1.0 / static_cast<double>(std::count(letters.begin(), letters.end(), letter)));
  }
  return {"the word " + letters, word(letters), c, {1, false, false}};
}

}  // namespace

const std::vector<family>& families_as_data() {
  static const std::vector<family> all = [] {
    std::vector<family> result;
    for_each<all_families>([&]<class F>() { result.emplace_back(F()); });
    return result;
  }();
  return all;
}

Eigen::VectorXd random_theta(const family& family, draws& random) {
  Eigen::VectorXd theta = family.starts.front().theta;
  for (Eigen::Index k = 0; k < theta.size(); ++k) {
    const auto [low, high, open] = family.ranges[static_cast<std::size_t>(k)];
    theta[k] = random.uniform(std::max(low + 0.2 * (high - low), theta[k] - 0.3),
                              std::min(high - 0.2 * (high - low), theta[k] + 0.3));
  }
  return theta;
}

std::vector<method> methods_as_data(draws& random) {
  std::vector<method> all;
  for_each<fitted_methods>([&]<class M>() { all.push_back(M::at(random.uniform(0.1, 4.0))); });
  for (const auto& row : detail::classical_table) {
    if (!has(std::string(row.letters), 'O') || row.name == "baoab") all.push_back(detail::as_data(row));
  }
  all.emplace_back(s_aia2(random.uniform(0.1, 2.8)));  // where it is not yet Verlet
  all.emplace_back(s_aia3(random.uniform(0.1, 5.1)));
  for (const auto& family : families_as_data()) all.push_back(random_member(family, random));
  return all;
}

std::vector<method> methods_for_baths(draws& random) {
  std::vector<method> all;
  for (const auto& row : detail::classical_table) {
    if (has(std::string(row.letters), 'O')) all.push_back(detail::as_data(row));
  }
  const nysalt::family family{nystrom()};
  all.push_back(random_member(thermostatted(family, placement::symmetric), random));
  all.push_back(random_member(thermostatted(family, placement::middle), random));
  for (const char* letters : {"BABO", "OBA", "OBOOAO"}) all.push_back(shared_equally(letters));
  return all;
}

}  // namespace nysalt::test
