// SPDX-License-Identifier: BSL-1.0
// Words of one length keep their plans apart. g++ 12 took template parameters that are arrays of equal
// length for one another, and words stepped in one program then shared the plan of the first of them.
#include "nysalt/detail/prepared_word.hpp"

#include <boost/test/unit_test.hpp>

#include "laws/noisy_models.hpp"
#include "laws/run_laws.hpp"
#include "support/noises.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// Steps the words one after the other: merged runs against plain steps, which have plans of their own.
template <class Methods>
void step_all(const auto& system, const auto& noise) {
  draws random;
  const auto x = random.state(system, 0.5);
  for_each<Methods>([&]<class M>() {
    BOOST_TEST(merging_broken(system, any_method<M>(random), 0.02, x, 20, noise) <= 1.0, M::word::letters());
  });
}

using of_four = std::tuple<shared_equally<kick, drift, kick, O>, shared_equally<O, drift, kick, O>,
                           shared_equally<drift, O, kick, drift>, shared_equally<kick, O, drift, kick>>;
using of_five = std::tuple<baoab, obabo, aboba, shared_equally<O, O, kick, drift, O>,
                           shared_equally<kick, drift, kick, drift, O>>;
using of_five_alone = std::tuple<baoab, obabo, aboba, member<nystrom>, verlet_2x, bcss2>;

}  // namespace

BOOST_AUTO_TEST_CASE(words_of_equal_length_do_not_share_their_plans) {
  const auto alone = an_fpu_chain::make();
  const in_bath warm(alone, bath::of_sigma(0.3, 0.1));
  step_all<of_four>(warm, fresh_noise(1));
  step_all<of_five>(warm, fresh_noise(1));
  step_all<of_five_alone>(alone, no_noise());
}
