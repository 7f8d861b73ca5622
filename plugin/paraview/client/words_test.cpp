// What stops the force, what cannot be felt and what tissue lies at the stylus is said in the user's language.
#include "plugin/paraview/client/words.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "device/link/protocol.h"
#include "device/messages.h"
#include "device/safety/safety_filter.h"
#include "io/messages.h"
#include "modes/scene/ct_tissues.h"
#include "plugin/messages/messages.h"
#include "plugin/paraview/client/words/testing/german.h"

namespace palpate::plugin {
namespace {

bool is_german(const Text& text) {
  return !text.empty() && words(text) != QString::fromStdString(text);
}

TEST(German, HasEachReasonWhyTheForceStops) {
  const testing::German german;
  int faults = 0;
  for (int n = 1; !device::advice_for(static_cast<device::Fault>(n)).empty(); ++n, ++faults) {
    EXPECT_TRUE(is_german(device::advice_for(static_cast<device::Fault>(n)))) << n;
  }
  EXPECT_GE(faults, 8);
  for (int n = 1; !device::advice_for(static_cast<device::LinkFault>(n)).empty(); ++n, ++faults) {
    EXPECT_TRUE(is_german(device::advice_for(static_cast<device::LinkFault>(n)))) << n;
  }
  EXPECT_GE(faults, 19);
  for (const Text& text : {say("paraview-session-ended"), say("scan-left-the-pipeline"),
                           say("scan-is-still-being-read"), say("no-view-shows-the-scan")}) {
    EXPECT_TRUE(is_german(text)) << text;
  }
  for (const Text& text : {io::say("none-of-its-images-can-be-read"), io::say("localizer-no-volume"),
                           io::say("one-slice-alone-is-no-volume")}) {
    EXPECT_TRUE(is_german(text)) << text;
  }
}

TEST(German, KeepsTheValuesOfAMessage) {
  const testing::German german;
  const QString said = words(say("another-scan-is-active-in-the-pipeline", "CT, {} of \xC3\x84", "MR. Choose"));
  EXPECT_EQ(said.toStdString(),
            "eine andere Aufnahme, CT, {} of \xC3\x84, ist in ParaViews Liste offener Daten, dem Pipeline Browser, "
            "gew\xC3\xA4hlt. W\xC3\xA4hlen Sie dort MR. Choose, "
            "dann dr\xC3\xBC"
            "cken Sie F\xC3\xBChlen");
  const Text recording = say("recording-was-read-for-another-frame", "a.h5");
  EXPECT_EQ(
      std::string(recording),
      "a.h5 was not opened: another frame was chosen while it was read. Open it again to see what was recorded on "
      "this frame.");
  EXPECT_TRUE(is_german(recording) && words(recording).startsWith(QLatin1String("a.h5 ")));
  EXPECT_TRUE(is_german(say("recording-is-of-another-frame", "a.h5")));
  // What the catalogue does not have stays as it is.
  const Text unknown = say("boundary-is-another-one", "Skin");
  EXPECT_EQ(words(unknown).toStdString(), std::string(unknown));
}

TEST(German, NamesEachTissueOfACt) {
  const testing::German german;
  std::set<std::string> names;
  for (int hu = -1100; hu < 4000; hu += 10) names.insert(modes::ct_tissue(hu));
  EXPECT_EQ(names.size(), 6U);
  for (const std::string& name : names) EXPECT_NE(tissue_in_words(name).toStdString(), name);
  EXPECT_EQ(tissue_in_words("Tissue 2").toStdString(), "Tissue 2");
}

TEST(German, HasNoMessageThatIsInNoTable) {
  std::set<QString> all;
  const auto take = [&](const auto& table) {
    for (const MessageRow& row : table) {
      for (const Message& message : row.messages) all.insert(QString::fromStdString(std::string(message.text)));
    }
  };
  take(device::messages::styluses);
  take(io::messages::series);
  take(messages::paraview);
  int found = 0;
  for (const auto& [key, text] : testing::german_catalogue()) {
    if (key.first != QLatin1String("Messages")) continue;
    ++found;
    EXPECT_TRUE(all.contains(key.second)) << key.second.toStdString();
    EXPECT_EQ(key.second.count(QLatin1String("{}")), text.count(QLatin1String("{}"))) << text.toStdString();
  }
  EXPECT_GE(found, 28);
}

}  // namespace
}  // namespace palpate::plugin
