#include "energy/connection.h"
namespace fairing {
Connection::Connection(const Lattice& lattice) : rows_(lattice) {}
}  // namespace fairing
