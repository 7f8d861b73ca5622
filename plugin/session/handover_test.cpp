/// What is given to the servo and comes back: nothing is lost, freed twice, or freed by the servo, in whatever order.

#include "plugin/session/handover.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <set>
#include <vector>

namespace palpate::plugin {
namespace {

struct Handed {
  Handed(int its_number, std::multiset<int>& its_freed) : number(its_number), freed(its_freed) {}
  ~Handed() { freed.insert(number); }
  Handed(const Handed&) = delete;
  Handed& operator=(const Handed&) = delete;
  int number;
  std::multiset<int>& freed;
  Handed* next_returned = nullptr;
};

TEST(Handover, EachItemIsFreedOnceByTheGiver) {
  std::mt19937 random(5);
  for (int round = 0; round < 200; ++round) {
    std::multiset<int> freed, wanted;
    int given = 0, offered = -1;  // -1: none
    {
      Handover<Handed> handover;
      std::vector<Handed*> held;
      std::vector<int> returned;
      for (int step = 0; step < 60; ++step) {
        switch (random() % 5) {
          case 0:
          case 1:
            if (offered >= 0) wanted.insert(offered);
            handover.give(std::make_unique<Handed>(given, freed));
            offered = given++;
            break;
          case 2: {
            Handed* const taken = handover.take();
            ASSERT_EQ(taken == nullptr ? -1 : taken->number, offered) << "the last that was given";
            if (taken != nullptr) held.push_back(taken);
            offered = -1;
            break;
          }
          case 3:
            if (held.empty()) break;
            std::swap(held[random() % held.size()], held.back());
            returned.push_back(held.back()->number);
            handover.give_back(held.back());
            held.pop_back();
            break;
          default:
            ASSERT_EQ(handover.collect(), !returned.empty());
            wanted.insert(returned.begin(), returned.end());
            returned.clear();
            break;
        }
        ASSERT_EQ(handover.is_offered(), offered >= 0);
        ASSERT_EQ(freed, wanted);
      }
      for (Handed* const item : held) handover.give_back(item);
    }
    ASSERT_EQ(freed.size(), static_cast<std::size_t>(given)) << "and the rest with the handover itself";
    ASSERT_EQ(std::set<int>(freed.begin(), freed.end()).size(), freed.size());
  }
}

}  // namespace
}  // namespace palpate::plugin
