#include "demos/viewer/key_map.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace nacre {
namespace {

TEST(KeyMap, EachKeyAndActionOnceAndExplained) {
    std::set<int> keys;
    std::set<Action> actions;
    for (const KeyBinding& binding : keyBindings()) {
        EXPECT_TRUE(keys.insert(binding.key).second) << binding.name;
        EXPECT_TRUE(actions.insert(binding.action).second) << binding.name;
        EXPECT_NE(std::string(binding.help), "") << binding.name;
        EXPECT_EQ(actionOf(binding.key), binding.action);
    }
    EXPECT_EQ(actions.size(), static_cast<std::size_t>(Action::Quit) + 1);  // none without a key
    EXPECT_FALSE(actionOf('Q'));
    EXPECT_GE(mouseBindings().size(), 5u);
}

}  // namespace
}  // namespace nacre
