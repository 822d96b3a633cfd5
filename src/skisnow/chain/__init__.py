"""From a campaign to a turn in one call: analysis, the snow of a site, a turn with each contact, a band, one page.

The package can be called: `skisnow.chain(…)` is `skisnow.chain.chaining.chain`.
"""

from ..callable_packages import make_callable

make_callable(__name__, ".chaining", "chain")
