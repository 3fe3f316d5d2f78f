// SPDX-License-Identifier: BSL-1.0
#include "words.hpp"

#include <stdexcept>

#include "nysalt/families/composition.hpp"
#include "nysalt/families/gradient_composition.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/family.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/s_aia.hpp"

namespace nysalt::hard {

namespace {

template <Family F>
method at(const std::vector<double>& theta) {
  return member(F(), theta);
}

}  // namespace

std::vector<method> classical_words() {
  return {verlet{}, verlet_aba{},  verlet_2x{}, mclachlan2{},       bcss2{},      s_aia2(2.0),
          bcss3{},  forest_ruth{}, pefrl{},     mclachlan_atela4{}, mclachlan5{}, blanes_moan_s6{},
          srkn6b{}, srkn11b{},     srkn14a{},   takahashi_imada{},  chin4a{}};
}

method nystrom_with_two_windows() { return at<nystrom>({0.5, 0.4}); }

// nysalt learn --system fpu --omega 50 --family fg4 --step 0.04 --horizon 1
method learned_fg4_for_fpu() {
  return at<fg4>({0.08477993577793687, 0.24182139245615147, 0.006850153862931222});
}
// nysalt learn --system kepler --eccentricity 0.6 --family fg4 --step 0.04 --horizon 6.4
method learned_fg4_for_kepler() {
  return at<fg4>({0.12524779420575805, 0.29677301660722233, 0.005141281528300977});
}
// nysalt learn --system henon_heiles --family fg4 --step 0.16 --horizon 8
method learned_fg4_for_henon_heiles() {
  return at<fg4>({0.09097585561966703, 0.249041410902533, 0.0068315121820252});
}

// nysalt learn --system fpu --omega 50 --family r_aba4 --step k pi/50 --horizon 2
method learned_r_aba4_at_resonance(int k) {
  switch (k) {
    case 1:
      return at<r_aba<4>>({0.09636575218850416, 0.22714522603811674, 0.27389636996967061});
    case 2:
      return at<r_aba<4>>({0.08012875652600618, 0.19757055980742305, 0.26682336897793996});
    case 3:
      return at<r_aba<4>>({0.11615997986489199, 0.250922712727601, 0.26829932305294013});
    default:
      throw std::invalid_argument("learned_r_aba4_at_resonance: k is 1, 2 or 3");
  }
}

std::vector<method> learned_words() {
  return {nystrom_with_two_windows(),
          at<nystrom>({0.5118648628270795, 0.407489150143317}),  // --family nystrom --step 0.02 --horizon 0.5
          learned_fg4_for_fpu(), learned_fg4_for_kepler(),
          // --family aba6 --step 0.06 --horizon 1.2
          at<aba<6>>({0.13418353315406706, -0.4063879464910628, -0.010648747574905582, 0.62813755357462,
                      0.21850885423366442}),
          // --family aba3_free --step 0.03 --horizon 1.2
          at<aba3_free>({0.20140938142683681, 0.7126180273557275, -0.1735753621901456, -0.14343554274830805,
                         0.8088532376065679})};
}

std::vector<contender> side_by_side(const method& learned) {
  return {{"verlet", verlet{}},
          {"mclachlan2", mclachlan2{}},
          {"srkn6b", srkn6b{}},
          {"srkn11b", srkn11b{}},
          {"learned fg4", learned, true}};
}

}  // namespace nysalt::hard
