"""`amuros completion` and `amuros lsp`: what a shell and an editor need of the commands."""

from __future__ import annotations

import os

import click

#: Where the script for bash takes a completion.
_PLAIN = "COMPREPLY+=($value)"


@click.command("completion")
@click.argument("shell", type=click.Choice(("bash", "zsh", "fish")))
@click.pass_context
def completion(context: click.Context, shell: str) -> None:
    r"""Print what makes a shell complete commands, options and files.

    \b
    Add this to ~/.bashrc:                   eval "$(amuros completion bash)"
    Add this to ~/.zshrc, after compinit:    eval "$(amuros completion zsh)"
    Write it to a file for fish:             amuros completion fish > ~/.config/fish/completions/amuros.fish
    """
    from click.shell_completion import get_completion_class

    complete = get_completion_class(shell)
    assert complete is not None
    script = complete(context.find_root().command, {}, "amuros", "_AMUROS_COMPLETE").source()
    # A value follows a key at once.
    click.echo(script.replace(_PLAIN, f"{_PLAIN}\n            [[ $value == *= ]] && compopt -o nospace"))


@click.command("lsp")
@click.option("--stdio", is_flag=True, hidden=True, help="The default, which some editors state.")
def lsp(stdio: bool) -> None:
    """Run the language server on standard input and output; editors start it.

    While an app.yaml or .amxmi file is edited, it shows the findings of `amuros check`, repairs what `--fix` repairs, and shows
    response times and latencies at the names of tasks, callbacks and chains.
    """
    try:
        import pygls  # noqa: F401
    except ImportError:
        raise click.UsageError('the language server needs pygls; install it with: pip install "amuros[lsp]"') from None
    from amalthea_uros.editor.server import create_server

    # Standard output belongs to the protocol: whatever else is printed goes to the log of the editor.
    protocol = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    create_server().start_io(stdout=protocol)
