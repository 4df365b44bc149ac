#include "bodies.hpp"
#include "catch.hpp"
#include "resolve/friction_rows.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

constexpr int kCapacity = 12;

Contact random_contact(std::mt19937& rng) {
  Contact c{random_direction(rng), random_vector(rng, 0.03), 0, {}, 0};
  c.part.index = static_cast<std::uint32_t>(rng() % 3);
  if (rng() % 5 == 0) c.age = kOneShotAge;
  return c;
}

/// What a part does between two programs: it stands, turns, meets or leaves a contact.
void change(std::mt19937& rng, std::vector<Contact>& contacts, Metric& metric) {
  switch (rng() % 5) {
    case 0:
      metric.set_orientation(rotation(3 * random_direction(rng)));
      break;
    case 1:
      if (contacts.size() < kCapacity)
        contacts.insert(contacts.begin() + static_cast<std::ptrdiff_t>(rng() % (contacts.size() + 1)),
                        random_contact(rng));
      break;
    case 2:
      if (!contacts.empty()) contacts.erase(contacts.begin() + static_cast<std::ptrdiff_t>(rng() % contacts.size()));
      break;
    case 3:
      if (!contacts.empty()) {
        Contact& c = contacts[rng() % contacts.size()];
        (rng() % 2 == 0 ? c.r : c.n) = random_direction(rng);
      }
      break;
    default:
      if (!contacts.empty()) contacts[rng() % contacts.size()].part.index = static_cast<std::uint32_t>(rng() % 3);
  }
}

}  // namespace

TEST_CASE("tangents say how far a contact slides, whatever rows were kept from before", "[resolve]") {
  std::mt19937 rng(16);
  const std::vector<double> mu = {0.3, 0, 0.7};
  FrictionRows rows(mu, kCapacity);
  Metric metric(0.02);
  std::vector<Contact> contacts;
  int rubbing = 0;
  for (int round = 0; round < 20000; ++round) {
    change(rng, contacts, metric);
    const bool any = rows.fill(contacts, metric);
    const Displacement d{random_vector(rng, 1e-3), random_vector(rng, 1e-2)};
    const Vec6 z = metric.whiten(d);
    const LowRankMatrix normals(1);
    const FrictionProblem problem = rows.problem(normals, nullptr, Vec6::Zero(), kNoDeadline);
    bool expected = false;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      const Contact& c = contacts[i];
      const double known = c.age == kOneShotAge ? 0 : mu[c.part.index];
      REQUIRE(rows.mu(i) == known);
      if (known == 0) continue;
      expected = true;
      ++rubbing;
      const Vec3 way = d.dp + d.dr.cross(c.r), slip = way - c.n.dot(way) * c.n;
      const TangentRows& t = problem.tangents[i];
      REQUIRE(std::hypot(t.row[0].dot(z), t.row[1].dot(z)) == Approx(slip.norm()).epsilon(1e-9).margin(1e-15));
    }
    REQUIRE(any == expected);
  }
  CHECK(rubbing > 10000);
}
