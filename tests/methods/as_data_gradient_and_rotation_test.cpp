// SPDX-License-Identifier: BSL-1.0
// Words with gradient kicks or rotations take, by their types, the steps of their tables.
#include <boost/test/unit_test.hpp>

#include "../laws/data_laws.hpp"

using namespace nysalt;
using namespace nysalt::test;

using these =
    joined<gradient_methods, members_of<gradient_families>, rotating_methods, members_of<rotating_families>>;
using another_system = std::tuple<a_split_ring>;
using a_few = std::tuple<verlet, chin4a, impulse>;

BOOST_AUTO_TEST_CASE_TEMPLATE(a_type_steps_as_its_table, M, these) { try_as_data<M, one_system>(); }

BOOST_AUTO_TEST_CASE_TEMPLATE(also_in_a_dynamic_dimension, M, a_few) { try_as_data<M, another_system>(); }
