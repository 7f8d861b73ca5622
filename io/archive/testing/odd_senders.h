#pragma once

/// How a misbehaving archive sends images: on a connection there is, or by a call to the store service on a port of
/// this machine.

#include <string>

namespace palpate::io::testing {

void begin_image(int socket, int context, const std::string& study);
void send_without_end(int socket, int context, const std::string& study);
/// A byte a while in the midst of a PDU: never silent, and never done.
void drip(int socket, int context, const std::string& study);

/// Connects under an AE title, and requests an association. -1: nothing listens there.
int call(int port, std::string calling, std::string called = "PALPATE");
/// Connects and begins to ask for an association, a byte every 0.2 s, for a minute or until it is let go.
void call_hesitantly(int port);
/// Prints the answer to a caller that the store service does not know, or that calls it by a wrong name: 3 rejects, and
/// the reason.
void call_as_stranger(int port, bool knows_us);
/// Talks as an archive does, and prints the answers: to an echo, to an image of a class other than the first context's,
/// and to a release or, instead, to a request that is not supported. `title`: what it calls itself.
void talk(int port, const std::string& study, bool asks, const std::string& title = "ODD");
/// While an association is open, others connect and reset their connections at once, before anyone can answer them.
/// Then it is released.
void call_and_hang_up(int port, int others);
/// One image, a piece every 0.1 s for 5 s.
void send_slowly(int port, const std::string& study);

}  // namespace palpate::io::testing
