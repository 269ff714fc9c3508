/* The command "rhegma keys", which prints the keys of a case file; no MPI. */
#ifndef RG_KEYS_COMMAND_H
#define RG_KEYS_COMMAND_H

/* Runs "rhegma keys ..." with argv[1] = "keys"; returns the exit status. */
int rg_keys_command(int argc, char **argv);

#endif
