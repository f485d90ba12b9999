#include "cli/verb.hpp"

int main(int argc, char** argv) { return nacre::cli::runCommand(argc, argv); }
