// The main() of every test program. Written out because the macro BOOST_TEST_MODULE, which would
// make one, cannot be defined where <boost/test/unit_test.hpp> is precompiled.
#include <boost/test/unit_test.hpp>

int main(int argc, char** argv) {
  return boost::unit_test::unit_test_main([] { return true; }, argc, argv);
}
