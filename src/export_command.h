/* The command "rhegma export", which makes files for other programs of what a run left; no MPI. */
#ifndef RG_EXPORT_COMMAND_H
#define RG_EXPORT_COMMAND_H

/* Runs "rhegma export ..." with argv[1] = "export"; returns the exit status. */
int rg_export_command(int argc, char **argv);

#endif
