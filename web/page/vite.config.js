export default { base: './', worker: { format: 'es' }, build: { target: 'es2022', assetsInlineLimit: 0 } };
