#pragma once

/// How a misbehaving archive sends images: on an existing connection, or on a new connection to the store service on a
/// port of this machine.

#include <string>

namespace palpate::io::testing {

void begin_image(int socket, int context, const std::string& study);
void send_without_end(int socket, int context, const std::string& study);
/// Sends single bytes of a PDU with pauses: never silent for long, and never finished.
void drip(int socket, int context, const std::string& study);

/// Connects under an AE title, and requests an association. -1: nothing listens there.
int call(int port, std::string calling, std::string called = "PALPATE");
/// Connects and requests an association, one byte every 0.2 s, for a minute or until the connection is closed.
void call_hesitantly(int port);
/// Prints the answer to a caller whose AE title the store service does not know, or that calls it by a wrong AE title:
/// 3 (reject), and the reason.
void call_as_stranger(int port, bool knows_us);
/// Sends requests as an archive does, and prints the answers: to an echo, to an image of a class other than the first
/// context's, and to a release or, if `asks`, to a request that is not supported. `title`: its own AE title.
void talk(int port, const std::string& study, bool asks, const std::string& title = "ODD");
/// While an association is open, others connect and reset their connections at once, before anyone can answer them.
/// Then it is released.
void call_and_hang_up(int port, int others);
/// One image, a piece every 0.1 s for 5 s.
void send_slowly(int port, const std::string& study);

}  // namespace palpate::io::testing
