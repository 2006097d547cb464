"""`amuros completion`: what a shell needs to complete our commands."""

from __future__ import annotations

import click
from click.shell_completion import get_completion_class

_SHELLS = ("bash", "zsh", "fish")


@click.command("completion")
@click.argument("shell", type=click.Choice(_SHELLS))
@click.pass_context
def command(context: click.Context, shell: str) -> None:
    r"""Print what makes a shell complete commands, options and files.

    \b
    Add this to ~/.bashrc:                   eval "$(amuros completion bash)"
    Add this to ~/.zshrc, after compinit:    eval "$(amuros completion zsh)"
    Write it to a file for fish:             amuros completion fish > ~/.config/fish/completions/amuros.fish
    """
    complete = get_completion_class(shell)
    assert complete is not None
    click.echo(complete(context.find_root().command, {}, "amuros", "_AMUROS_COMPLETE").source())
