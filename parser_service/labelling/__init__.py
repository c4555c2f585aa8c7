"""Forms to choose from for an utterance: of the grammar, of its nearest neighbours, of the best parser.

The grammar and the neighbours answer in the web process, which never loads torch; what a trained
parser answers was computed by a worker (``parser_proposals``) and stands in ``Proposal`` rows.
"""
