#include "platform/content_key.hpp"

#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("keys are FNV-1a: its published values") {
  CHECK(fnv1a("") == 0xcbf29ce484222325ull);
  CHECK(fnv1a("a") == 0xaf63dc4c8601ec8cull);
  CHECK(fnv1a("foobar") == 0x85944171f73967e8ull);
  CHECK(content_key("foobar") == "85944171f73967e8");
  CHECK(fnv1a("bar", fnv1a("foo")) == fnv1a("foobar"));
}
