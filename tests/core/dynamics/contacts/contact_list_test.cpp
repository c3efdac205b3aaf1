// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/contacts/contact_list.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace tesserae {
namespace {

/// 0 to count - 1.
unsigned draw(unsigned count, std::mt19937& random) {
    return std::uniform_int_distribution<unsigned>(0, count - 1)(random);
}

/// Contacts of one pair: up to eight, whose normals change now and then.
std::vector<Contact> random_contacts(BodyId a, BodyId b, std::mt19937& random, unsigned least) {
    std::vector<Contact> list(least + draw(9 - least, random));
    Vec4 normal = Vec4::UnitX();
    std::uint32_t feature = 0;
    for (Contact& c : list) {
        if (draw(3, random) == 0) normal = Vec4::Unit(draw(4, random));
        c.normal = normal, c.point = Vec4::Random(), c.separation = 1e-3 * c.point[0];
        c.a = a, c.b = b, c.feature = feature += 1 + draw(5, random);
    }
    return list;
}

void expect_equal(const ContactList& list, const ContactList& expected) {
    ASSERT_EQ(list.size(), expected.size());
    ASSERT_EQ(list.run_count(), expected.run_count());
    for (std::size_t n = 0; n < list.run_count(); ++n) {
        const ContactList::Run run = list.nth_run(n), other = expected.nth_run(n);
        ASSERT_EQ(run.begin, other.begin) << n;
        ASSERT_EQ(run.end, other.end) << n;
    }
    for (std::size_t i = 0; i < list.size(); ++i) {
        const Contact c = list[i], d = expected[i];
        ASSERT_EQ(c.a, d.a) << i;
        ASSERT_EQ(c.b, d.b) << i;
        ASSERT_EQ(c.feature, d.feature) << i;
        ASSERT_EQ(c.normal, d.normal) << i;
        ASSERT_EQ(c.point, d.point) << i;
        ASSERT_EQ(c.separation, d.separation) << i;
    }
}

/// Some pairs' contacts replaced, in lists that get shorter, longer, and both in turn, against a
/// list that is made of the new contacts.
TEST(ContactList, ReplacesContactsAsIfItHadBeenMadeOfTheNewOnes) {
    std::mt19937 random(15);
    for (int round = 0; round < 2000; ++round) {
        const BodyId pairs = draw(12, random);
        const unsigned part = 1 + draw(3, random);
        std::vector<Contact> before, after;
        std::vector<std::vector<Contact>> by(pairs);
        std::vector<ContactList::Replacement> replacements;
        for (BodyId pair = 0; pair < pairs; ++pair) {
            const std::vector<Contact> old = random_contacts(pair, pair + 1, random, 1);
            by[pair] = old;
            if (draw(part, random) == 0) {
                by[pair] = random_contacts(pair, pair + 1, random, 0);
                replacements.push_back({before.size(), before.size() + old.size(), by[pair]});
            }
            before.insert(before.end(), old.begin(), old.end());
            after.insert(after.end(), by[pair].begin(), by[pair].end());
        }
        ContactList list(before);
        list.replace(replacements);
        expect_equal(list, ContactList(after));
    }
}

}  // namespace
}  // namespace tesserae
