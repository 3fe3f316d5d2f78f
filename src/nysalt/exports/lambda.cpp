// SPDX-License-Identifier: BSL-1.0
// Export to lattice codes that take the one parameter of the two-stage word: Chroma, tmLQCD, openQCD.
#include "exported_method.hpp"
#include "exports.hpp"
#include "fill.hpp"

namespace nysalt::detail {

namespace {

/// Where the self-test of a host must end, which the text itself cannot compute.
constexpr const char* test_sentence =
    R"(@MARK@ Test: two oscillators f = (-q1 - 2 q1 q2, -q2 - q1^2 + q2^2) with the masses 1 and 2 go by ten steps of 0.1 from
@MARK@ q = (0.3, 0.2), p = (0.1, -0.25) to q = (@Q@), p = (@P@).
)";

gap_texts values_of_lambda(const exported_method& method, const std::string& host, const std::string& mark) {
  const double lambda = two_stage_lambda(method, host);
  auto values = values_of_header(method, mark);
  values.emplace_back("MARK", mark);
  values.emplace_back("LAMBDA", digits(lambda));
  values.emplace_back("TEST", fill(test_sentence, values));
  return values;
}

}  // namespace

std::string export_to_chroma(const exported_method& method) {
  auto values = values_of_lambda(method, "chroma", " ");
  std::string comment = fill("@HEADER@@EXPLAINED@\n@TEST@", values);
  // A comment of XML may not hold two dashes.
  for (std::size_t at = comment.find("--"); at != std::string::npos; at = comment.find("--", at))
    comment.replace(at, 2, "- -");
  values.emplace_back("COMMENT", comment);
  return fill(R"(<!--
@COMMENT@  An integrator of Chroma: n_steps steps a trajectory, monomial_ids as yours are.
-->
<Integrator>
  <Name>LCM_STS_MIN_NORM_2</Name>
  <n_steps>10</n_steps>
  <lambda>@LAMBDA@</lambda>
  <monomial_ids>
    <elem>MONOMIAL</elem>
  </monomial_ids>
</Integrator>
)",
              values);
}

std::string export_to_tmlqcd(const exported_method& method) {
  return fill(R"(@HEADER@#
@EXPLAINED@
# One time scale of tmLQCD, whose number is in the names: IntegrationSteps0 steps a trajectory.
@TEST@BeginIntegrator
  Type0 = 2MN
  IntegrationSteps0 = 10
  Tau = 1
  Lambda0 = @LAMBDA@
  NumberOfTimescales = 1
EndIntegrator
)",
              values_of_lambda(method, "tmlqcd", "#"));
}

std::string export_to_openqcd(const exported_method& method) {
  return fill(R"(@HEADER@#
@EXPLAINED@
# One level of openQCD: nstep steps a trajectory or a step of the level above, forces as yours are.
@TEST@[Level 0]
integrator    OMF2
lambda        @LAMBDA@
nstep         10
forces        0
)",
              values_of_lambda(method, "openqcd", "#"));
}

}  // namespace nysalt::detail
