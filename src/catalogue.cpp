// SPDX-License-Identifier: BSL-1.0
#include "catalogue.hpp"

#include <algorithm>

#include "nysalt/methods/baoab.hpp"
#include "nysalt/methods/bcss.hpp"
#include "nysalt/methods/blanes_moan.hpp"
#include "nysalt/methods/chin.hpp"
#include "nysalt/methods/forest_ruth.hpp"
#include "nysalt/methods/impulse.hpp"
#include "nysalt/methods/mclachlan.hpp"
#include "nysalt/methods/mclachlan_atela.hpp"
#include "nysalt/methods/pefrl.hpp"
#include "nysalt/methods/takahashi_imada.hpp"
#include "nysalt/methods/verlet.hpp"

namespace nysalt::program {

std::vector<std::string> family_names() {
  std::vector<std::string> names;
  std::apply([&](auto... family) { (names.emplace_back(family.name), ...); }, families{});
  return names;
}

tabulated family_member(const std::string& family, const std::vector<double>& parameters) {
  std::optional<tabulated> result;
  with_family(family, [&]<class F>(F) {
    parameters_of<F> theta;
    if (parameters.size() != theta.size()) {
      refuse("the family {} has {} parameters ({}), got {}", family, theta.size(), listed(F::parameter_names),
             parameters.size());
    }
    std::copy(parameters.begin(), parameters.end(), theta.begin());
    result.emplace(member<F>(theta));
  });
  return *result;
}

const std::vector<classical_method>& classical_methods() {
  static const std::vector<classical_method> all{
      {tabulated(verlet{}), "verlet_1967"},
      {tabulated(verlet_aba{}), "verlet_1967"},
      {tabulated(verlet_2x{}), "verlet_1967"},
      {tabulated(mclachlan2{}), "mclachlan_1995"},
      {tabulated(bcss2{}), "blanes_casas_sanz_serna_2014"},
      {tabulated(bcss3{}), "blanes_casas_sanz_serna_2014"},
      {tabulated(forest_ruth{}), "forest_ruth_1990"},
      {tabulated(pefrl{}), "omelyan_mryglod_folk_2002"},
      {tabulated(mclachlan_atela4{}), "mclachlan_atela_1992"},
      {tabulated(mclachlan5{}), "mclachlan_1995"},
      {tabulated(blanes_moan_s6{}), "blanes_moan_2002"},
      {tabulated(srkn6b{}), "blanes_moan_2002"},
      {tabulated(srkn11b{}), "blanes_moan_2002"},
      {tabulated(srkn14a{}), "blanes_moan_2002"},
      {tabulated(takahashi_imada{}), "takahashi_imada_1984"},
      {tabulated(chin4a{}), "chin_1997"},
      {tabulated(impulse{}), "tuckerman_berne_martyna_1992"},
      {tabulated(baoab{}), "leimkuhler_matthews_2013"},
      {tabulated(baoab_2x{}), "leimkuhler_matthews_2013"},
      {tabulated(aboba{}), "leimkuhler_matthews_2013"},
      {tabulated(obabo{}), "bussi_parrinello_2007"},
  };
  return all;
}

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const auto& known : classical_methods()) names.push_back(known.method.name());
  names.emplace_back(adaptive_method);
  return names;
}

placement placement_named(const std::string& name) {
  for (const auto known : placements) {
    if (to_string(known) == name) return known;
  }
  refuse("unknown placement '{}': it is one of end, symmetric, middle", name);
}

coordinates coordinates_named(const std::string& name) {
  for (const auto known : {coordinates::qp, coordinates::modes, coordinates::energy}) {
    if (to_string(known) == name) return known;
  }
  refuse("unknown coordinates '{}': they are one of qp, modes, energy", name);
}

}  // namespace nysalt::program
