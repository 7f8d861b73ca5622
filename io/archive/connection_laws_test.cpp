// The storage service and the watch over a connection, each by itself: what is said where the service cannot listen,
// what is left of callers that hang up, and how often the watch asks.

#include <dcmtk/config/osconfig.h>
// DCMTK's configuration comes first.
#include <arpa/inet.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmnet/dul.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "io/archive/inbox.h"
#include "io/archive/send.h"
#include "io/archive/store_server.h"
#include "io/archive/testing/odd_archive.h"
#include "io/archive/transport.h"
#include "io/fresh_folder.h"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using std::chrono::steady_clock;
using ::testing::HasSubstr;
using testing::OddArchive;

/// Why nobody can listen there.
std::string why_not(const std::string& address, int port, const std::function<void()>& before = {},
                    const std::function<void()>& after = {}) {
  const FreshFolder folder = temporary_folder();
  Archive archive;
  archive.name = "a";
  archive.listen_address = address;
  archive.listen_port = port;
  Inbox inbox(folder.path() / "fetched", {});
  std::string said = "it listens";
  if (before) before();
  try {
    const StoreServer server(archive, inbox);
  } catch (const ArchiveError& error) {
    said = error.what();
  }
  if (after) after();
  return said;
}

/// The system's own words.
TEST(StoreService, SaysWhyItCannotListen) {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  ASSERT_EQ(bind(socket, reinterpret_cast<const sockaddr*>(&address), size), 0);
  ASSERT_EQ(listen(socket, 1), 0);
  ASSERT_EQ(getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size), 0);
  EXPECT_THAT(why_not("127.0.0.1", ntohs(address.sin_port)), HasSubstr("(Address already in use)"));
  close(socket);
  EXPECT_THAT(why_not("192.0.2.1", testing::free_port()), HasSubstr("(Cannot assign requested address)"))
      << "an address for examples alone (RFC 5737)";
  EXPECT_EQ(why_not("127.0.0.1", testing::free_port()), "it listens");
}

TEST(StoreService, SaysThatThereAreTooManyFiles) {
  rlimit usual{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &usual), 0);
  const auto none_left = [&] {
    const int next = dup(STDIN_FILENO);
    close(next);
    const rlimit few{static_cast<rlim_t>(next), usual.rlim_max};
    setrlimit(RLIMIT_NOFILE, &few);
  };
  const std::string said =
      why_not("127.0.0.1", testing::free_port(), none_left, [&] { setrlimit(RLIMIT_NOFILE, &usual); });
  EXPECT_THAT(said, HasSubstr("(Too many open files)"));
}

std::ptrdiff_t open_files() {
  return std::distance(fs::directory_iterator("/proc/self/fd"), {});
}

/// Callers that reset their connections before they are served, by the system's queue: nothing of them stays open.
TEST(StoreService, KeepsNothingOfCallersThatHangUp) {
  OddArchive odd("others-hang-up");
  odd.archive().uses_get = false;
  std::ptrdiff_t before = 0;
  for (int n = 0; n < 2; ++n) {  // the first time DCMTK may open files of its own
    before = n == 0 ? 0 : open_files();
    const FreshFolder folder = temporary_folder();
    EXPECT_EQ(fetch(odd.archive(), {"1.2.3"}, folder.path() / "fetched").files, 1U);
  }
  EXPECT_EQ(open_files(), before);
  EXPECT_EQ(dcmExternalSocketHandle.get(), -1) << "DCMTK's switch is left as it was";
}

/// Spaces at either end do not belong to a title (PS3.5 6.2), whoever writes them.
TEST(StoreService, LetsAnArchiveInThatWritesItsTitleWithSpaces) {
  OddArchive odd("tells-its-title-with-spaces");
  odd.archive().uses_get = false;
  EXPECT_EQ(fetch(odd.archive(), {"1.2.3"}, odd.folder()).files, 1U);
}

/// DCMTK's switch: with it, no name is looked up for who connects, which may take long where no server of names
/// answers.
TEST(StoreService, LooksUpNobodysName) {
  OddArchive odd("good");
  EXPECT_NO_THROW(echo(odd.archive()));
  EXPECT_TRUE(dcmDisableGethostbyaddr.get());
}

/// Waits for what has to come, however slow the machine is.
bool comes(const std::function<bool()>& it) {
  const auto begin = steady_clock::now();
  while (!it() && steady_clock::now() - begin < std::chrono::seconds(60)) std::this_thread::sleep_for(milliseconds(1));
  return it();
}

TEST(WatchOfAConnection, AsksAtOnceAndThenOnceASecond) {
  std::atomic<int> asked{0};
  const auto begin = steady_clock::now();
  {
    Watch watch(-1, 60);
    const Watch::Asking asking(watch, [&] {
      ++asked;
      return true;
    });
    EXPECT_TRUE(comes([&] { return asked > 0; }));
    std::this_thread::sleep_for(milliseconds(100));
    EXPECT_FALSE(watch.ended());
  }
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(steady_clock::now() - begin).count();
  EXPECT_LE(asked, 2 + seconds);
}

/// Where the question is answered by no, or by an exception, which whoever asks next hears of.
TEST(WatchOfAConnection, EndsWhereNobodyWantsToGoOn) {
  for (const bool throws : {false, true}) {
    Watch watch(-1, 3600);
    EXPECT_FALSE(watch.ended());
    EXPECT_FALSE(watch.cancelled());
    const Watch::Asking asking(watch, [&] {
      if (throws) throw std::runtime_error("gone");
      return false;
    });
    EXPECT_TRUE(comes([&] { return watch.ended(); })) << throws;
    EXPECT_TRUE(watch.cancelled());
  }
}

/// The peer hears of it, and nobody has canceled.
TEST(WatchOfAConnection, EndsItsConnectionAfterASilence) {
  int sockets[2];
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, sockets), 0);
  {
    const auto begin = steady_clock::now();
    const Watch watch(sockets[0], 1);
    EXPECT_FALSE(watch.ended());
    char byte = 0;
    EXPECT_EQ(read(sockets[1], &byte, 1), 0) << "shut down";
    EXPECT_GE(steady_clock::now() - begin, milliseconds(990));
    EXPECT_TRUE(watch.ended());
    EXPECT_FALSE(watch.cancelled());
  }
  close(sockets[0]);
  close(sockets[1]);
}

/// PS3.8 9.3.2.2: a presentation context has an odd number of a byte. What is left over when these are used up is not
/// taken, and is told.
TEST(OnTheWire, AssociationsHaveNoMoreContextsThanThereAreNumbers) {
  const FreshFolder folder = temporary_folder();
  std::vector<fs::path> files;
  constexpr int kinds = 130, numbers = 128;
  for (int n = 0; n < kinds; ++n) {
    DcmFileFormat format;
    format.getDataset()->putAndInsertString(DCM_SOPClassUID, ("1.2.826.0.1." + std::to_string(n)).c_str());
    format.getDataset()->putAndInsertString(DCM_SOPInstanceUID, ("1.2.3." + std::to_string(n)).c_str());
    files.push_back(folder.path() / (std::to_string(n) + ".dcm"));
    ASSERT_TRUE(format.saveFile(files.back().c_str(), EXS_LittleEndianExplicit).good());
  }
  OddArchive odd("tells");
  const Sent sent = send(odd.archive(), files);
  EXPECT_EQ(sent.files, static_cast<std::size_t>(numbers));
  ASSERT_EQ(sent.not_sent.size(), static_cast<std::size_t>(kinds - numbers));
  EXPECT_EQ(sent.not_sent.front().file, files[numbers]);
  EXPECT_EQ(odd.process().read_line(), "PALPATE calls ODD");
  for (int n = 0; n < numbers; ++n) {
    EXPECT_THAT(odd.process().read_line(),
                HasSubstr("context " + std::to_string(2 * n + 1) + " 1.2.826.0.1." + std::to_string(n) + " "));
  }
  EXPECT_THAT(odd.process().read_line(), HasSubstr("command 0001"));
}

}  // namespace
}  // namespace palpate::io
